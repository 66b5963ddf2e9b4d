// SPDX-License-Identifier: MIT
/// Exchanges values between a thread that calls a vendor's library and the daemon's servo thread. In both directions
/// only the newest value is passed on, and no thread waits for the other.
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

/// The newest values that the vendor's library has given.
struct ArmReading {
  /// time_ns: CLOCK_MONOTONIC when the position was read. sequence: number of the position; 0 if none has come.
  uint64_t time_ns = 0, sequence = 0;
  double position[3] = {};  ///< [m]
  uint32_t buttons = 0;
  bool calibrated = false, fault = false, lost = false;
};

class Exchange {
 public:
  /// [main] Resets the exchange: no position has come, and the wanted force is zero.
  /// @param max_force [N] largest force
  void reset(double max_force) {
    max_force_ = max_force;
    cut_ = lost_ = false;
    ok_ = true;
    seen_.back() = {}, seen_.publish();
    wanted_.back() = {}, wanted_.publish();
  }

  /// [main] Waits for the first position, at most 2 s. @return true if it came
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

  // ---- for the thread that calls the vendor's library
  void show(const ArmReading& seen) noexcept {
    seen_.back() = seen;
    seen_.publish();
    ok_ = !seen.lost && !seen.fault;
  }
  /// Writes the force to apply now [N] to `out`. It is at most max_force. It is zero during a cut, while the arm is
  /// lost or has a fault, and if the servo has sent no command for 20 ms.
  void force(double out[3]) noexcept {
    constexpr uint64_t kOldNs = 20'000'000;
    const bool cut = cut_.load(std::memory_order_acquire);  // before the command is taken
    wanted_.update();
    const ForceCommand& wanted = wanted_.front();
    std::fill_n(out, 3, 0.0);
    const double size = std::hypot(wanted.force[0], wanted.force[1], wanted.force[2]);
    const bool old = monotonicNow() > wanted.time_ns + kOldNs;
    if (cut || old || !ok_ || !std::isfinite(size)) return;
    const double share = size > max_force_ ? max_force_ / size : 1;
    for (int i = 0; i < 3; ++i) out[i] = wanted.force[i] * share;
  }

  // ---- for the servo thread
  hsp_status read(hdv_sample& sample) noexcept HSP_RT {
    seen_.update();
    const ArmReading& seen = seen_.front();
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
    ForceCommand wanted;
    wanted.time_ns = monotonicNow();
    for (int i = 0; i < 3; ++i)
      if (command.mode == HDV_TORQUE && std::isfinite(command.torque[i])) wanted.force[i] = command.torque[i];
    wanted_.back() = wanted;
    wanted_.publish();
    // last, so that no command from before the cut is sent
    if (command.mode == HDV_OFF) cut_.store(false, std::memory_order_release);
    return HSP_OK;
  }
  void cut() noexcept HSP_RT { cut_.store(true, std::memory_order_relaxed); }          ///< [any] no force until HDV_OFF
  bool lost() const noexcept HSP_RT { return lost_.load(std::memory_order_relaxed); }  ///< [any]

 private:
  struct ForceCommand {
    uint64_t time_ns = 0;  ///< CLOCK_MONOTONIC when the command was written
    double force[3] = {};  ///< [N]
  };
  TripleBuffer<ArmReading> seen_;
  TripleBuffer<ForceCommand> wanted_;
  std::atomic<bool> cut_{false}, lost_{false};
  bool ok_ = true;  ///< the arm is neither lost nor at fault; used only by the thread that calls the library
  double max_force_ = 0;
};

}  // namespace hapticd::vendor_arm
