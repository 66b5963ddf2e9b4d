// SPDX-License-Identifier: MIT
/// The running servo as watchdog and crash handler see it.
#pragma once
#include <memory>
#include <vector>

#include "servo/loop/loop.hpp"
#include "session/telemetry.hpp"
#include "session/world.hpp"
#include "watch/watched.hpp"

namespace hapticd::servo {

class WatchedServo final : public watch::Watched {
 public:
  /// [main] All of them outlive it.
  WatchedServo(const Loop& loop, World& world, std::vector<std::unique_ptr<Arm>>& arms, const Telemetry& telemetry);

  uint64_t ticks() const noexcept override { return loop_.ticks(); }
  Nanoseconds tickBegun() const noexcept override { return loop_.tickBegun(); }
  Nanoseconds cpuTime() const noexcept override { return loop_.cpuTime(); }
  bool simulated() const noexcept override { return simulated_; }
  void cut(double stuck_for) noexcept override;
  const char* plugin() const noexcept override;
  const char* model() const noexcept override;
  const void* blackBox() const noexcept override;
  size_t blackBoxBytes() const noexcept override;

 private:
  const host::ShapeInstance* culprit() const noexcept;

  const Loop& loop_;
  World& world_;
  std::vector<std::unique_ptr<Arm>>& arms_;
  const Telemetry& telemetry_;
  bool simulated_ = true;
};

}  // namespace hapticd::servo
