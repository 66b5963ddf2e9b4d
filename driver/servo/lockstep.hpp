/// Runs the simulation side in step with simulated time, so that virtual runs and traces are the same every time: a
/// search at the start, every 5 ms, and in the tick after a jump or a lost track.
#pragma once
#include "servo/world.hpp"

namespace hapticd::servo {

class Lockstep {
 public:
  explicit Lockstep(World& world) : world_(world) {}

  /// Before a tick at time t [s], after the probes were published.
  void before(double t) {
    constexpr double kPeriod = static_cast<double>(sim::kSearchPeriod) * kSecondsPerNanosecond;
    constexpr double kRounding = 1e-9;  // [s] so that 5 ms in ticks of 1 ms are five ticks
    const bool due = !started_ || t - last_ >= kPeriod - kRounding;
    if (!due && !world_.core().wantsSearch()) return;
    if (due) last_ = t;
    started_ = true;
    world_.proximity().search();
  }

 private:
  World& world_;
  bool started_ = false;
  double last_ = 0;
};

}  // namespace hapticd::servo
