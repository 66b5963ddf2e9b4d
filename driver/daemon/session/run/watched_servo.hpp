// SPDX-License-Identifier: MIT
/// The interface through which the watchdog and the crash handler see the running servo.
#pragma once
#include <memory>
#include <vector>

#include "servo/loop/loop.hpp"
#include "session/telemetry/telemetry.hpp"
#include "watch/watch_target.hpp"

namespace hapticd::servo {

class WatchedServo final : public watch::WatchTarget {
 public:
  /// [main] The arguments must outlive this object.
  WatchedServo(Loop& loop, Arms& arms, const Telemetry& telemetry);

  uint64_t ticks() const noexcept override { return loop_.ticks(); }
  uint64_t beats() const noexcept override { return loop_.beats(); }
  Nanoseconds tickBegun() const noexcept override { return loop_.tickBegun(); }
  Nanoseconds nextTick() const noexcept override { return loop_.nextTick(); }
  Nanoseconds cpuTime() const noexcept override { return loop_.cpuTime(); }
  bool simulated() const noexcept override { return simulated_; }
  void stop() noexcept override { loop_.stop(); }
  Nanoseconds stopAsked() const noexcept override { return loop_.stopAsked(); }
  void cut(double stuck_for) noexcept override;
  bool cutLeft() const noexcept override;
  const Owner* inServo() const noexcept override { return ownerOfWorker(Worker::kServo); }
  const void* blackBox() const noexcept override;
  size_t blackBoxBytes() const noexcept override;

 private:
  Loop& loop_;
  Arms& arms_;
  const Telemetry& telemetry_;
  const bool simulated_;
};

}  // namespace hapticd::servo
