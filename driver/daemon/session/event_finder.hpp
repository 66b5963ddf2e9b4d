// SPDX-License-Identifier: MIT
/// Finds what happened in a tick: the changes that a person or a program wants to be told of, out of states that are
/// there every tick. Runs in the servo thread.
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
  static constexpr double kFreeFor = 0.05;       ///< [s] away from a model before another touch is reported
  static constexpr double kRefusedPeriod = 1.0;  ///< [s] between two reports about a leader that is refused
  static constexpr size_t kMost = 64;            ///< events that one tick reports; more are dropped

  /// [main] @param places most models that there may be @param arms of the scene
  EventFinder(size_t places, size_t arms) : models_(places), arms_(arms) {}

  /// [rt] An order that the tick obeys.
  void order(const Order& order) noexcept HSP_RT;
  /// [rt] After a tick at t [s].
  void tick(double t, const Core& core, const std::vector<std::unique_ptr<Arm>>& arms) noexcept HSP_RT;

  /// [rt] Events of this tick, without their number; the next call of forget() forgets them.
  std::span<const hapticd_event> found() const noexcept { return {found_.data(), count_}; }
  void forget() noexcept HSP_RT { count_ = 0; }  ///< [rt]

 private:
  /// How a model was a tick ago.
  struct ModelNote {
    std::array<double, link::kMaxProbes> touched = never();  ///< [s] the last time that a probe was inside
    uint32_t level = 0;
    Trouble trouble = Trouble::kNone;
    bool leaving = false;
    uint64_t refused = 0;
    double refused_told = -kRefusedPeriod;
  };
  struct RefusedNote {
    uint64_t refused = 0;
    double refused_told = -kRefusedPeriod;
  };
  struct ArmNote : RefusedNote {  // for the leader of the hand
    Fault fault = Fault::kNone;
    RefusedNote pushes;
  };
  static constexpr std::array<double, link::kMaxProbes> never() {
    std::array<double, link::kMaxProbes> times{};
    times.fill(-std::numeric_limits<double>::infinity());
    return times;
  }
  void add(uint32_t kind, int32_t model, int32_t probe, uint32_t code, double value) noexcept HSP_RT;
  void look(double t, uint32_t index, const Core& core) noexcept HSP_RT;
  void look(double t, uint32_t index, const Arm& arm) noexcept HSP_RT;
  void lookForLeft(const Core& core) noexcept HSP_RT;
  template <class Note>
  bool refused(double t, uint64_t now, Note& note) noexcept HSP_RT;

  double last_t_ = std::numeric_limits<double>::quiet_NaN();  ///< [s] of the tick before
  std::vector<ModelNote> models_;
  std::vector<ArmNote> arms_;
  std::array<hapticd_event, kMost> found_{};
  size_t count_ = 0, leaving_ = 0;
};

/// [main] For a refused target of a model or a hand: what was wrong with it; "" for another event.
const char* whyRefused(const hapticd_event& event);

/// [main] "click", as in JSON; "" for a number that means none.
const char* nameOfEvent(uint32_t kind);

}  // namespace hapticd::servo
