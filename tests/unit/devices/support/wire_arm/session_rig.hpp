// SPDX-License-Identifier: MIT
/// A session of an emulated board, at the level of bytes and in virtual time.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>

#include "emulators/board.hpp"
#include "emulators/wire_file.hpp"
#include "wire_arm/session.hpp"

namespace hapticd::wire_arm {

inline constexpr Nanoseconds kMs = 1'000'000;

/// A board at 1 kHz and a host that pushes all the time; time runs in steps of 250 us.
class Rig {
 public:
  explicit Rig(Calibration calibration = Calibration::kDevice)
      : wire_(codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/premium15.yaml"), 3)),
        session_(wire_, settings(calibration)) {
    session_.attach(now_, {}, calibration == Calibration::kPose);
  }

  using Spoil = std::function<bool(std::vector<uint8_t>&)>;  ///< false: nothing is sent

  /// Runs for some time; `spoil` may change what the board sends.
  void run(double seconds, const Spoil& spoil = {}) {
    const Nanoseconds until = now_ + static_cast<Nanoseconds>(seconds * 1e9);
    while (now_ < until) {
      now_ += kMs / 4;
      if (++quarter_ % 4 == 0) {
        ++board.sequence;
        std::vector<uint8_t> bytes = board.bytes();
        if (attached && (!spoil || spoil(bytes))) session_.receive(now_, bytes);
        if (host_writes)
          command_.time = now_, ++command_.sequence, command_.on = true, command_.torque = {0.1, 0.1, 0.1};
      }
      session_.watch(now_);
      std::array<uint8_t, 64> out{};
      const emulator::BoardCommand command({out.data(), session_.command(now_, command_, out)});
      ASSERT_TRUE(command.valid);
      current_ = command.enabled ? command.current[0] : 0;
      if (command.pushes()) pushed_at_ = now_;
    }
  }

  /// Time from `since` to the last command that pushed [s].
  double pushedFor(Nanoseconds since) const {
    return pushed_at_ > since ? static_cast<double>(pushed_at_ - since) * 1e-9 : 0;
  }
  bool pushes() const { return pushed_at_ == now_; }

  static SessionSettings settings(Calibration calibration) {
    SessionSettings s;
    s.calibration = calibration;
    return s;
  }

  emulator::BoardState board;
  bool attached = true, host_writes = true;
  codec::Wire wire_;
  Session session_;
  ArmCommand command_;
  Nanoseconds now_ = 1000 * kMs, pushed_at_ = 0;
  int quarter_ = 0, current_ = 0;
};

}  // namespace hapticd::wire_arm
