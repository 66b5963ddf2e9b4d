// SPDX-License-Identifier: MIT
/// Watches a command that runs the servo core without a servo loop: if a step of a plugin does not return, the plugin
/// is named and the command ends.
#pragma once
#include "base/offline_tick.hpp"
#include "base/thread_usage.hpp"
#include "watch/crash.hpp"
#include "watch/end_watch.hpp"
#include "watch/idle_target.hpp"

namespace hapticd::cli {

class TickWatch {
 public:
  /// [main] Construct it in the thread that ticks. If no watching thread can be started, nothing is watched.
  TickWatch() { (void)watch_.start(); }

 private:
  /// Tells EndWatch the ticks of a command. The command has no servo loop, but a tick may still hang.
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
    if (const Owner* keeps = ownerOfWorker(Worker::kMain)) watch::endByFault("a step that did not come back", keeps);
  }

  Ticks ticks_;
  watch::EndWatch watch_{ticks_, [] {}, &TickWatch::end};
};

}  // namespace hapticd::cli
