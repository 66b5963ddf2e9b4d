// SPDX-License-Identifier: MIT
/// Between a thread that talks to a vendor's library and the daemon's servo: newest value wins in both directions, and
/// neither waits for the other.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>

#include "base/clock.hpp"
#include "base/triple_buffer.hpp"
#include "hapticd/device.h"

namespace hapticd::vendor_arm {

struct Seen {
  uint64_t time_ns = 0, sequence = 0;  ///< CLOCK_MONOTONIC; grows with each new position; 0: no position has come yet
  double position[3] = {};             ///< [m]
  uint32_t buttons = 0;
  bool calibrated = false, fault = false, lost = false;
};

class Exchange {
 public:
  /// [main] Nothing has been measured yet and no force is wanted.
  void reset(double max_force) {
    max_force_ = max_force;
    cut_ = lost_ = false;
    ok_ = true;
    seen_.back() = {}, seen_.publish();
    wanted_.back() = {}, wanted_.publish();
  }

  /// [main] Waits for the first position for 2 s at most. @return whether there is one
  bool awaitFirst() noexcept {
    constexpr int kTries = 200;
    constexpr std::chrono::milliseconds kPause(10);
    for (int i = 0; i < kTries; ++i) {
      seen_.update();
      if (seen_.front().sequence > 0) return true;
      std::this_thread::sleep_for(kPause);
    }
    return false;
  }

  // ---- the vendor's side
  void show(const Seen& seen) noexcept {
    seen_.back() = seen;
    seen_.publish();
    ok_ = !seen.lost && !seen.fault;
  }
  /// The force to apply now [N]: none while the arm is cut or unwell, or when the daemon's servo has fallen silent;
  /// never beyond the bound.
  void force(double out[3]) noexcept {
    constexpr uint64_t kOldNs = 20'000'000;
    wanted_.update();
    const Wanted& wanted = wanted_.front();
    std::fill_n(out, 3, 0.0);
    const double size = std::hypot(wanted.force[0], wanted.force[1], wanted.force[2]);
    const bool old = monotonicNow() > wanted.time_ns + kOldNs;
    if (cut_.load(std::memory_order_relaxed) || old || !ok_ || !std::isfinite(size)) return;
    const double share = size > max_force_ ? max_force_ / size : 1;
    for (int i = 0; i < 3; ++i) out[i] = wanted.force[i] * share;
  }

  // ---- the servo's side
  hsp_status read(hdv_sample& sample) noexcept HSP_RT {
    seen_.update();
    const Seen& seen = seen_.front();
    lost_.store(seen.lost, std::memory_order_relaxed);
    std::copy_n(seen.position, 3, sample.position);
    sample.time_ns = seen.time_ns, sample.sequence = seen.sequence;
    sample.buttons = seen.buttons;
    sample.flags = 0;
    if (seen.calibrated) sample.flags |= HDV_S_CALIBRATED;
    if (seen.fault) sample.flags |= HDV_S_FAULT;
    if (seen.lost) sample.flags |= HDV_S_LOST;
    return HSP_OK;
  }
  hsp_status write(const hdv_command& command) noexcept HSP_RT {
    if (command.mode == HDV_OFF) cut_.store(false, std::memory_order_relaxed);
    Wanted wanted;
    wanted.time_ns = monotonicNow();
    for (int i = 0; i < 3; ++i)
      if (command.mode == HDV_TORQUE && std::isfinite(command.torque[i])) wanted.force[i] = command.torque[i];
    wanted_.back() = wanted;
    wanted_.publish();
    return HSP_OK;
  }
  void cut() noexcept HSP_RT { cut_.store(true, std::memory_order_relaxed); }  ///< [any] allows no force until HDV_OFF
  bool lost() const noexcept HSP_RT { return lost_.load(std::memory_order_relaxed); }  ///< [any]

 private:
  struct Wanted {
    uint64_t time_ns = 0;  ///< CLOCK_MONOTONIC when the wish was written
    double force[3] = {};  ///< [N]
  };
  TripleBuffer<Seen> seen_;
  TripleBuffer<Wanted> wanted_;
  std::atomic<bool> cut_{false}, lost_{false};
  bool ok_ = true;  ///< the vendor's side
  double max_force_ = 0;
};

}  // namespace hapticd::vendor_arm
