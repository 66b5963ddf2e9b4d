// SPDX-License-Identifier: MIT
/// No servo, as the crash handler sees it: a run that has ended, modules that are set up, or a command without an arm.
/// No tick is to come, and the motors are off.
///
/// Watched itself has no defaults, so that the compiler names what a running servo forgot to answer.
#pragma once
#include "watch/watched.hpp"

namespace hapticd::watch {

class Ended : public Watched {
 public:
  uint64_t ticks() const noexcept override { return 0; }
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
