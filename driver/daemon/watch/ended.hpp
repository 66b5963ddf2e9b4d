// SPDX-License-Identifier: MIT
/// A run that has ended, as the crash handler sees it: no tick is to come, and the motors are off.
///
/// Watched itself has no defaults, so that the compiler names what a running servo forgot to answer.
#pragma once
#include "watch/watched.hpp"

namespace hapticd::watch {

class Ended final : public Watched {
 public:
  uint64_t ticks() const noexcept override { return 0; }
  Nanoseconds tickBegun() const noexcept override { return 0; }
  Nanoseconds nextTick() const noexcept override { return 0; }
  Nanoseconds cpuTime() const noexcept override { return 0; }
  bool simulated() const noexcept override { return true; }
  void stop() noexcept override {}
  Nanoseconds stopAsked() const noexcept override { return 0; }
  void cut(double) noexcept override {}
  bool cutLeft() const noexcept override { return true; }
  const Owner* inServo() const noexcept override { return nullptr; }
  const void* blackBox() const noexcept override { return nullptr; }
  size_t blackBoxBytes() const noexcept override { return 0; }
};

}  // namespace hapticd::watch
