// SPDX-License-Identifier: MIT
/// Finds the events of a tick: compares the states of this tick with the last one, and reports changes that a user or a
/// program wants to know. Runs in the servo thread.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "hapticd/client.h"
#include "link/link.hpp"
#include "servo/arm/arm.hpp"
#include "servo/core/core.hpp"
#include "servo/core/order.hpp"

namespace hapticd::servo {

class EventFinder {
 public:
  /// [s] the probe must have been outside for this time before another touch is reported
  static constexpr double kFreeFor = 0.05;
  /// [s] least time between two reports about refused records of a leader
  static constexpr double kRefusedPeriod = 1.0;
  static constexpr size_t kMost = 64;  ///< most events of one tick; more are dropped

  /// [main] @param places most models that the run can have @param arms number of arms
  EventFinder(size_t places, size_t arms) : models_(places), arms_(arms) {}

  /// [rt] Called for each order that this tick obeys.
  void order(const Order& order) noexcept HSP_RT;
  /// [rt] Called for each mark of this tick. @param number number of its row in the stream `marks`
  void mark(uint32_t number) noexcept HSP_RT { add(HAPTICD_MARK, -1, -1, number, 0); }
  /// [rt] Called after a tick at t [s]: finds its events.
  void tick(double t, const Core& core, const Arms& arms) noexcept HSP_RT;

  /// [rt] Returns the events of this tick, not yet numbered; valid until forget().
  std::span<const hapticd_event> found() const noexcept { return {found_.data(), count_}; }
  void forget() noexcept HSP_RT { count_ = 0; }  ///< [rt] removes the events of this tick

 private:
  struct RefusedNote {
    uint64_t refused = 0;
    double refused_told = -kRefusedPeriod;
  };
  /// The state of a model one tick ago.
  struct ModelNote : RefusedNote {
    std::array<double, link::kMaxProbes> touched = never();  ///< [s] time when each probe was last inside
    double at_end = never()[0];  ///< [s] time when its joint was last at an end of its range
    uint32_t level = 0;
    ShapeFault fault = ShapeFault::kNone;
    bool leaving = false, seen = false;  ///< seen: it was stepped
  };
  struct ArmNote : RefusedNote {  // its own counts are for the leader of the hand, `pushes` for the pushing programs
    Fault fault = Fault::kNone;
    uint32_t faults = 0;  ///< number of faults until then
    RefusedNote pushes;
  };
  static constexpr std::array<double, link::kMaxProbes> never() {
    std::array<double, link::kMaxProbes> times{};
    times.fill(-std::numeric_limits<double>::infinity());
    return times;
  }
  void add(uint32_t kind, int32_t model, int32_t probe, uint32_t code, double value) noexcept HSP_RT;
  void check(double t, uint32_t index, const Core& core) noexcept HSP_RT;
  void check(double t, uint32_t index, const Arm& arm) noexcept HSP_RT;
  void findEnd(double t, int32_t number, const ModelState& model, ModelNote& note) noexcept HSP_RT;
  void findLeft(const Core& core) noexcept HSP_RT;
  template <class Note>
  bool refused(double t, uint64_t now, Note& note) noexcept HSP_RT;

  double last_t_ = std::numeric_limits<double>::quiet_NaN();  ///< [s] time of the last tick
  std::vector<ModelNote> models_;
  std::vector<ArmNote> arms_;
  std::array<hapticd_event, kMost> found_{};
  size_t count_ = 0, leaving_ = 0;
};

/// [main] Returns why the target of a lead was refused, for an event HAPTICD_REFUSED; "" for other events.
const char* whyRefused(const hapticd_event& event);

/// [main] Returns "in" or "out" for an event HAPTICD_CLICK whose direction is known; "" for other events.
const char* directionOfClick(const hapticd_event& event);

/// [rt] Returns HAPTICD_LOWEST or HAPTICD_HIGHEST if the joint of a model stands at that end of its range; else 0.
uint32_t endOf(const ModelState& model) noexcept HSP_RT;

/// [main] Returns "lowest" or "highest" for an event HAPTICD_END_STOP; "" for other events.
const char* endOf(const hapticd_event& event);

/// [main] Returns the name of an event in JSON, such as "click"; "" if there is no such event.
const char* nameOfEvent(uint32_t kind);

}  // namespace hapticd::servo
