// SPDX-License-Identifier: MIT
/// The WatchTarget for a process without a running servo: after a run, during the set-up of modules, or in a command
/// without an arm. There are no ticks, and the motors are off.
///
/// These functions are not defaults of WatchTarget, so that the compiler reports each function that a running servo
/// does not implement.
#pragma once
#include "watch/watch_target.hpp"

namespace hapticd::watch {

class IdleTarget : public WatchTarget {
 public:
  uint64_t ticks() const noexcept override { return 0; }
  uint64_t beats() const noexcept override { return 0; }
  Nanoseconds tickBegun() const noexcept override { return 0; }
  Nanoseconds nextTick() const noexcept override { return 0; }
  Nanoseconds cpuTime() const noexcept override { return 0; }
  bool simulated() const noexcept override { return true; }
  bool drives() const noexcept override { return false; }
  void stop() noexcept override {}
  Nanoseconds stopAsked() const noexcept override { return 0; }
  void cut(double) noexcept override {}
  bool cutLeft() const noexcept override { return true; }
  const Owner* inServo() const noexcept override { return nullptr; }
  const void* blackBox() const noexcept override { return nullptr; }
  size_t blackBoxBytes() const noexcept override { return 0; }
};

}  // namespace hapticd::watch
