// SPDX-License-Identifier: MIT
#include "watch/end_watch.hpp"

#include <chrono>
#include <utility>

namespace hapticd::watch {

EndWatch::~EndWatch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_one();
  thread_.join();
}

std::error_code EndWatch::start() {
  return thread_.start("hapticd-watch", [this] { watch(); });
}

void EndWatch::lastCalls(std::function<void()> stuck) {
  const std::lock_guard lock(mutex_);
  stuck_ = std::move(stuck);
}

void EndWatch::watch() {
  std::unique_lock lock(mutex_);
  while (!stopped_.wait_for(lock, std::chrono::nanoseconds(kLookEvery), [this] { return stop_; }))
    check(monotonicNow());
}

/// A run with slow ticks gets the time to ramp its forces out. A run whose tick never ends cannot do that, so it is
/// ended.
void EndWatch::check(Nanoseconds now) noexcept {
  if (stuck_) {
    looked_last_ += kLookEvery;
    if (looked_last_ >= kWaitsForLast) stuck_();
    return;
  }
  const uint64_t ticks = servo_.ticks();
  checkForHang(ticks);
  const bool moved = std::exchange(ticks_, ticks) != ticks;
  if (servo_.stopAsked() == 0 || moved) {
    still_since_ = now;
    return;
  }
  if (now - still_since_ >= kEndWithin && !std::exchange(told_, true)) late_();
}

/// Time is counted by the number of calls, not by a clock. So a process that was stopped by a debugger, or a laptop
/// that slept, does not count as hanging.
void EndWatch::checkForHang(uint64_t ticks) noexcept {
  const Nanoseconds begun = servo_.tickBegun(), cpu = servo_.cpuTime();
  const bool watched = begun != 0 || servo_.drives();  // between its ticks a command without a servo may set up a model
  const bool same = std::exchange(tick_begun_, begun) == begun && watched && ticks == ticks_;
  if (!same) looked_ = 0, cpu_before_ = cpu;
  looked_ += kLookEvery;
  if (same && (cpu - cpu_before_ >= kHungAfter || looked_ >= kWaitsAfter)) hung_();
}

}  // namespace hapticd::watch
