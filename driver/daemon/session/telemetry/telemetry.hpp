// SPDX-License-Identifier: MIT
/// The statistics of a run, kept in the servo thread without allocation: histograms of times, contact statistics of
/// every model, and the black box of the last ten seconds.
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
#include "session/telemetry/flight.hpp"
#include "session/telemetry/sent_force.hpp"
#include "session/telemetry/status_writer.hpp"
#include "session/telemetry/stop_counts.hpp"
#include "session/telemetry/swing.hpp"

namespace hapticd::servo {

/// A short row about one tick: for the status line, and for the black box if there is no Flight.
struct BlackBoxRow {
  double t = 0;  ///< [s] time since the start of the run
  float lateness_us = 0, compute_us = 0;
  std::array<float, 3> position{};  ///< [m] tip of the first arm, world frame
  std::array<float, 3> force{};     ///< [N] force as sent to the first arm, world frame
  /// [m] depth of the deepest contact; negative: distance to the nearest foot point; 0: no model is traced
  float depth_m = 0;
  uint32_t model = UINT32_MAX;  ///< model of this contact or foot point
  int32_t status = 0;           ///< worst status of the tick
  uint32_t fault = 0;           ///< servo::Fault of the first arm
};

class Telemetry final : public TickLog {
 public:
  static constexpr double kBlackBoxSeconds = 10;
  static constexpr size_t kMostLeft = 64;

  /// [main] Allocates all memory and touches it.
  /// @param places most models that the run can have; 0: as many as the scene has
  Telemetry(const scene::Scene& scene, double rate, uint32_t places = 0);

  /// [main] Called before the servo adopts a model into an empty place. The counts of the newest kMostLeft models that
  /// have left stay in the report.
  void name(uint32_t place, const std::string& name, const std::string& plugin, const std::string& library);

  /// [main] From now on stores every tick, with all inputs and outputs, in this black box, instead of a short
  /// BlackBoxRow.
  void attach(std::unique_ptr<Flight> flight);
  /// [main] From now on also writes every tick to this status page.
  void attach(std::unique_ptr<StatusWriter> status) { status_ = std::move(status); }
  StatusWriter* statusWriter() { return status_.get(); }
  const StatusWriter* statusWriter() const { return status_.get(); }
  Flight* flight() { return flight_.get(); }
  const Flight* flight() const { return flight_.get(); }

  /// [main] Called when a program has stopped pushing: adds its counts.
  void pushed(const record::ClientReport& client) { record::add(clients_, client); }

  /// [rt] Called before a tick at time `now`.
  void begin(Nanoseconds now, const Arms& arms) noexcept HSP_RT override {
    if (flight_) flight_->begin(now, arms);
  }

  /// [rt] Called for each order that this tick obeys.
  void order(const Order& order) noexcept HSP_RT override {
    if (flight_) flight_->order(order);
  }

  /// [rt] Adds one tick to the statistics.
  void tick(double t, double dt, Nanoseconds late, const TickDuration& spent, const Core& core,
            const Arms& arms) noexcept HSP_RT override;

  /// [rt] `missed` whole periods were skipped.
  void overrun(uint64_t missed) noexcept HSP_RT override {
    ++overruns_;
    missed_ += missed;
  }

  /// [rt] Called at the end of the run, with the counts since the warm-up.
  void finish(uint64_t ticks, Nanoseconds elapsed, long page_faults, uint64_t allocations) noexcept override;

  /// [main] Returns the report that --report writes. @param faults messages of the faults
  record::RunReport report(const std::vector<std::string>& faults) const;

  /// [main] Returns what an arm gave to the hand.
  const SentForce& sent(size_t arm) const { return sent_[arm]; }
  /// [main] Returns how the tip of an arm swung while forces were allowed.
  const Swing& swing(size_t arm) const { return swings_[arm]; }

  /// [main] Returns the rows of the black box, oldest first.
  std::vector<BlackBoxRow> blackBox() const;

  /// [any] Returns the newest row for the status line. It may mix values of two ticks, so it is only for display.
  const BlackBoxRow& newest() const noexcept { return newest_; }

 private:
  std::vector<BlackBoxRow> fromFlight() const;
  void keep(const BlackBoxRow& row) noexcept HSP_RT;
  std::vector<record::ArmContact> armsOf(size_t place) const;
  static bool withoutForce(const Arms& arms) noexcept HSP_RT;
  void recordArms(uint32_t index, double dt, const Core& core, const Arms& arms) noexcept HSP_RT;
  /// [N] Largest force of a model on any probe in a tick, in cases without a proper contact: nothing traced, no depth,
  /// or outside the surface; and its largest pull.
  struct ImproperForce {
    double untraced = 0, depthless = 0, outside = 0, pull = 0;
  };
  void recordImproper(uint32_t index, const ImproperForce& odd) noexcept HSP_RT;
  void recordWork(uint32_t index, double dt, const Core& core, const Arms& arms) noexcept HSP_RT;
  record::ModelReport reportOf(size_t place) const;
  static double pullOf(const Contact& contact, const Arm& arm) noexcept HSP_RT;
  void recordModels(double dt, const Core& core, const Arms& arms, BlackBoxRow& row) noexcept HSP_RT;

  std::vector<std::string> names_, plugins_, libraries_;
  std::vector<record::ModelReport> left_;  ///< reports of models that have left
  std::vector<record::ClientReport> clients_;
  double rate_, simulated_seconds_ = 0;
  record::Histogram lateness_us_, compute_us_, arms_us_;
  std::vector<record::ContactStatistics> models_;
  std::vector<record::ContactWork> work_;          ///< [model * arms + arm]
  std::vector<std::string> devices_;               ///< names of the arms if there are several
  std::vector<record::ContactStatistics> by_arm_;  ///< [model * devices_.size() + arm]
  std::vector<BlackBoxRow> rows_;                  // used only without flight_
  std::vector<StopCounts> stops_;                  ///< statistics of joints at their stops, by arm
  std::vector<SentForce> sent_;                    ///< by arm
  std::vector<Swing> swings_;                      ///< by arm
  std::vector<std::string> all_devices_;           ///< names of all arms
  BlackBoxRow newest_;
  size_t next_ = 0, row_count_ = 0;
  uint64_t ticks_ = 0, overruns_ = 0, missed_ = 0, allocations_ = 0;
  long page_faults_ = 0;
  Nanoseconds elapsed_ = 0;
  std::unique_ptr<Flight> flight_;
  std::unique_ptr<StatusWriter> status_;
  uint64_t recorded_ = 0;
};

}  // namespace hapticd::servo
