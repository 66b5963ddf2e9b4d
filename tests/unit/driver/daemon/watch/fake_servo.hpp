// SPDX-License-Identifier: MIT
#pragma once
#include "watch/watch_target.hpp"

namespace hapticd::watch {

/// A servo whose state a test sets.
struct FakeServo : WatchTarget {
  uint64_t tick = 0, beat = 0;
  Nanoseconds begun = 0, next = 0, cpu = 0, asked = 0;
  bool harmless = false;
  int cuts = 0;
  const Owner* runs = nullptr;  ///< whose code the servo is in
  uint64_t ticks() const noexcept override { return tick; }
  uint64_t beats() const noexcept override { return beat; }
  Nanoseconds tickBegun() const noexcept override { return begun; }
  Nanoseconds nextTick() const noexcept override { return next; }
  Nanoseconds cpuTime() const noexcept override { return cpu; }
  bool simulated() const noexcept override { return harmless; }
  void cut(double) noexcept override { ++cuts; }
  void stop() noexcept override {}
  Nanoseconds stopAsked() const noexcept override { return asked; }
  bool cutLeft() const noexcept override { return true; }
  const Owner* inServo() const noexcept override { return runs; }
  const void* blackBox() const noexcept override { return nullptr; }
  size_t blackBoxBytes() const noexcept override { return 0; }
};

inline constexpr Nanoseconds kMs = 1'000'000;

}  // namespace hapticd::watch
