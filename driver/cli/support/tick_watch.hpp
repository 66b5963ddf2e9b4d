// SPDX-License-Identifier: MIT
/// Watches a command that steps the servo core without a servo loop. If a step of a plugin does not return, the command
/// ends with a message that names the plugin.
#pragma once
#include "base/offline_tick.hpp"
#include "base/thread_usage.hpp"
#include "watch/crash.hpp"
#include "watch/end_watch.hpp"
#include "watch/idle_target.hpp"

namespace hapticd::cli {

class TickWatch {
 public:
  /// [main] Create it in the thread that makes the ticks. If the watching thread cannot be started, nothing is watched.
  TickWatch() { (void)watch_.start(); }

 private:
  /// Gives EndWatch the ticks of the command, because a tick may hang even though there is no servo loop.
  class Ticks final : public watch::IdleTarget {
   public:
    uint64_t ticks() const noexcept override { return OfflineTick::ended(); }
    Nanoseconds tickBegun() const noexcept override { return static_cast<Nanoseconds>(OfflineTick::current()); }
    Nanoseconds cpuTime() const noexcept override { return static_cast<Nanoseconds>(os::cpuTime(clock_)); }
    const Owner* inServo() const noexcept override { return ownerOfWorker(Worker::kMain); }

   private:
    os::CpuClock clock_ = os::cpuClockOfThread();
  };

  static void end() noexcept {
    if (const Owner* keeps = ownerOfWorker(Worker::kMain)) watch::endByFault("a step that did not return", keeps);
  }

  Ticks ticks_;
  watch::EndWatch watch_{ticks_, [] {}, &TickWatch::end};
};

}  // namespace hapticd::cli
