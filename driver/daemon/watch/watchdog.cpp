// SPDX-License-Identifier: MIT
#include "watch/watchdog.hpp"

#include <algorithm>
#include <utility>

namespace hapticd::watch {

std::error_code Watchdog::start(int priority) {
  stop_ = false;
  return thread_.start("hapticd-watch", [this, priority] {
    (void)os::setFifo(priority);  // refused: it still watches, as well as the machine lets it
    RealClock clock(0);
    while (!stop_) {
      clock.waitUntil(clock.now() + kCheckEvery);
      check(clock.now());
    }
  });
}

void Watchdog::stop() {
  stop_ = true;
  thread_.join();
}

bool Watchdog::check(Nanoseconds now) noexcept {
  const Nanoseconds way = now - std::exchange(looked_at_, now);
  const Nanoseconds seen = way <= kOnTime ? way : kCheckEvery;
  const uint64_t tick = servo_.ticks();
  const Nanoseconds begun = servo_.tickBegun();
  if (begun == 0 || now <= begun) {
    tick_ = UINT64_MAX;
    return false;
  }
  const Nanoseconds stuck = now - begun;
  if (tick != tick_) {  // the first look at this tick
    tick_ = tick;
    cpu_at_tick_ = servo_.cpuTime();
    counted_ = 0;
  }
  counted_ = std::min(stuck, counted_ + seen);
  if (cut_tick_ == tick) {
    // Counted in looks, not in time: a machine that was asleep comes back to a tick that is still good.
    if (++checks_since_cut_ == kHungAfter / kCheckEvery) hung_();
    return false;
  }
  if (counted_ <= kStuckAfter || mayBePaused(stuck)) return false;
  servo_.cut(static_cast<double>(stuck) * kSecondsPerNanosecond);
  cut_tick_ = tick;
  checks_since_cut_ = 0;
  ++cuts_;
  return true;
}

/// Where no hand can be hurt, a thread that was merely not scheduled is no fault.
bool Watchdog::mayBePaused(Nanoseconds stuck) const noexcept {
  const bool works = servo_.cpuTime() - cpu_at_tick_ + kCheckEvery > kStuckAfter;
  return servo_.simulated() && !works && stuck <= kSimulatedPause;
}

}  // namespace hapticd::watch
