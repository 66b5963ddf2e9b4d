// SPDX-License-Identifier: MIT
/// The books of a run, kept in the servo thread without allocation: histograms of time, contact statistics of every
/// model, and the black box of the last ten seconds.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "record/contact_statistics.hpp"
#include "record/contact_work.hpp"
#include "record/histogram.hpp"
#include "record/report.hpp"
#include "servo/loop/tick_log.hpp"
#include "session/flight.hpp"
#include "session/status_writer.hpp"
#include "session/stop_counts.hpp"

namespace hapticd::servo {

/// One tick in the black box.
struct BlackBoxRow {
  double t = 0;  ///< [s] since the start
  float lateness_us = 0, compute_us = 0;
  std::array<float, 3> position{};  ///< [m] first arm, world
  std::array<float, 3> force{};     ///< [N] first arm, world, as sent
  float depth_m = 0;                ///< deepest contact; negative: distance of the nearest foot; 0: nothing traced
  uint32_t model = UINT32_MAX;      ///< of that foot
  int32_t status = 0;               ///< worst status of the tick
  uint32_t fault = 0;               ///< servo::Fault of the first arm
};

class Telemetry final : public TickLog {
 public:
  static constexpr double kBlackBoxSeconds = 10;
  static constexpr size_t kMostLeft = 64;

  /// [main] Allocates and touches everything.
  /// @param places most models that there may be; 0: those of the scene
  Telemetry(const scene::Scene& scene, double rate, uint32_t places = 0);

  /// [main] A model takes an empty place; before the servo adopts it. The counts of a model that left stay in the
  /// report, for the newest `kMostLeft` of them.
  void name(uint32_t place, const std::string& name, const std::string& plugin);

  /// [main] Keeps every tick in a black box, with all inputs and outputs; then the short rows kept so far are not
  /// needed.
  void attach(std::unique_ptr<Flight> flight);
  /// [main] Shows every tick on a page that others can read too.
  void attach(std::unique_ptr<StatusWriter> status) { status_ = std::move(status); }
  StatusWriter* statusWriter() { return status_.get(); }
  const StatusWriter* statusWriter() const { return status_.get(); }
  Flight* flight() { return flight_.get(); }
  const Flight* flight() const { return flight_.get(); }

  /// [main] A program pushed on an arm, and has stopped.
  void pushed(const record::ClientReport& client) { record::add(clients_, client); }

  /// [rt] Before a tick at time `now`.
  void begin(Nanoseconds now, const Arms& arms) noexcept HSP_RT override {
    if (flight_) flight_->begin(now, arms);
  }

  /// [rt] An order of a person, obeyed in this tick.
  void order(const Order& order) noexcept HSP_RT override {
    if (flight_) flight_->order(order);
  }

  /// [rt] Books one tick.
  void tick(double t, double dt, Nanoseconds late, const Spent& spent, const Core& core,
            const Arms& arms) noexcept HSP_RT override;

  /// [rt] `missed` whole periods were skipped.
  void overrun(uint64_t missed) noexcept HSP_RT override {
    ++overruns_;
    missed_ += missed;
  }

  /// [rt] The end of the run, with what was counted after the warm-up.
  void finish(uint64_t ticks, Nanoseconds elapsed, long page_faults, uint64_t allocations) noexcept override;

  /// [main] Everything as the report that --report writes. @param faults words for what went wrong
  record::RunReport report(const std::vector<std::string>& faults) const;

  /// [main] The black box, oldest row first.
  std::vector<BlackBoxRow> blackBox() const;

  /// [any] The newest row, for the status line; it may be torn, so it is only for people to look at.
  const BlackBoxRow& newest() const noexcept { return newest_; }

 private:
  std::vector<BlackBoxRow> fromFlight() const;
  void keep(const BlackBoxRow& row) noexcept HSP_RT;
  std::vector<record::ArmContact> armsOf(size_t place) const;
  static bool held(const std::vector<std::unique_ptr<Arm>>& arms) noexcept HSP_RT;
  void bookArms(uint32_t index, double dt, const Core& core,
                const std::vector<std::unique_ptr<Arm>>& arms) noexcept HSP_RT;
  /// [N] The force with which a model pushed in a tick, the largest of all probes, although no contact can be reported;
  /// and its pull.
  struct Odd {
    double untraced = 0, depthless = 0, outside = 0, pull = 0;
  };
  void bookOdd(uint32_t index, const Odd& odd) noexcept HSP_RT;
  void bookWork(uint32_t index, const Core& core, const std::vector<std::unique_ptr<Arm>>& arms) noexcept HSP_RT;
  record::ModelReport reportOf(size_t place) const;
  static double pullOf(const Contact& contact, const Arm& arm) noexcept HSP_RT;
  void bookModels(double dt, const Core& core, const std::vector<std::unique_ptr<Arm>>& arms,
                  BlackBoxRow& row) noexcept HSP_RT;

  std::vector<std::string> names_, plugins_;
  std::vector<record::ModelReport> left_;  ///< models that have left
  std::vector<record::ClientReport> clients_;
  double rate_, simulated_seconds_ = 0;
  record::Histogram lateness_us_, compute_us_, arms_us_;
  std::vector<record::ContactStatistics> models_;
  std::vector<record::ContactWork> work_;          ///< [model * arms + arm]
  std::vector<std::string> devices_;               ///< where there are several
  std::vector<record::ContactStatistics> by_arm_;  ///< [model * devices_.size() + arm]
  std::vector<BlackBoxRow> rows_;                  // used where there is no flight
  std::vector<StopCounts> stops_;                  ///< by arm
  std::vector<std::string> all_devices_;           ///< their names
  BlackBoxRow newest_;
  size_t next_ = 0, row_count_ = 0;
  uint64_t ticks_ = 0, overruns_ = 0, missed_ = 0, allocations_ = 0;
  long page_faults_ = 0;
  Nanoseconds elapsed_ = 0;
  std::unique_ptr<Flight> flight_;
  std::unique_ptr<StatusWriter> status_;
  uint64_t booked_ = 0;
};

}  // namespace hapticd::servo
