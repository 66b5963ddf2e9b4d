// SPDX-License-Identifier: MIT
/// One arm's reports become samples, and the host's torques become commands, but never a torque without a healthy
/// chain. Pure: bytes and time come in as arguments, so that every fault can be played in virtual time.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "base/clock.hpp"
#include "codec/framer.hpp"
#include "codec/report.hpp"
#include "codec/wire.hpp"
#include "wire_arm/trouble.hpp"

namespace hapticd::wire_arm {

using JointArray = std::array<double, codec::kMaxJoints>;

/// When an arm counts as unhealthy.
struct HealthLimits {
  double stale = 0.015;       ///< [s] without a good report
  double host_silent = 0.02;  ///< [s] without a command of the host; then the motors go off
  double least_rate = 0.57;   ///< share of wire.rate, over kRateWindow reports; 0: it is not watched
  double recovery = 0.2;      ///< [s] of health after which a trouble counts as over
  double ramp = 0.25;         ///< [s] from no torque to full torque after a trouble
  double max_speed = 100;     ///< [rad/s] of a joint; above it, an encoder jumped
};

/// How an arm gets absolute positions.
enum class Calibration : uint8_t {
  kNone,    ///< its encoders are absolute
  kDevice,  ///< it finds its zero by itself (index pulse, homing) and says so
  kPose,    ///< the user holds it in a known pose (inkwell, stop)
};

struct SessionSettings {
  size_t joints = 3;
  Calibration calibration = Calibration::kNone;
  HealthLimits health;
};

/// What the servo reads.
struct Sample {
  Nanoseconds time = 0;
  uint64_t sequence = 0;
  uint32_t buttons = 0;
  bool calibrated = false;
  Trouble trouble = Trouble::kStale;
  JointArray position{}, velocity{}, torque{};
};

/// What the servo writes.
struct Wish {
  Nanoseconds time = 0;
  uint64_t sequence = 0;            ///< grows with every write
  bool on = false, follow = false;  ///< with `follow`, positions are references in addition to the torques
  JointArray torque{}, position{};
};

class Session {
 public:
  Session(const codec::Wire& wire, const SessionSettings& settings);

  /// [any] The device was opened and started. @param zero positions [rad or m] to add; `calibrated`: they are right
  void attach(Nanoseconds now, const JointArray& zero, bool calibrated) noexcept;
  /// [any] The transport failed.
  void lose(Nanoseconds now, Trouble trouble) noexcept;
  /// [any] Takes one transfer. True if there is a new sample.
  bool receive(Nanoseconds now, std::span<const uint8_t> bytes) noexcept;
  /// [any] Judges the time since the last report. True if the verdict changed.
  bool watch(Nanoseconds now) noexcept;

  /// [any] The bytes of the next command: it has torques only if the arm is healthy and the wish is fresh.
  size_t command(Nanoseconds now, const Wish& wish, std::span<uint8_t> bytes) noexcept;

  const Sample& sample() const noexcept { return sample_; }
  Trouble trouble() const noexcept { return sample_.trouble; }
  /// Tells the arm to find its zero, or takes its present place as `pose`.
  void calibrateByDevice(bool wanted) noexcept { calibrate_ = wanted; }
  void setZero(const JointArray& zero) noexcept;
  /// Positions without the calibration.
  const JointArray& raw() const noexcept { return raw_; }
  uint64_t badReports() const noexcept { return bad_reports_; }

  static constexpr size_t kRateWindow = 10;

 private:
  bool take(Nanoseconds now, std::span<const uint8_t> bytes) noexcept;
  bool follow(Nanoseconds now, const codec::State& state) noexcept;
  void reject(codec::Verdict verdict) noexcept;
  void recover(Nanoseconds now) noexcept;
  double gain(Nanoseconds now, bool healthy) noexcept;
  bool tooSlow(Nanoseconds now) noexcept;
  void raise(Nanoseconds now, Trouble trouble) noexcept;
  void publish(Nanoseconds now, const codec::State& state) noexcept;
  bool startedAnew(Nanoseconds now) noexcept;
  bool again() const noexcept;

  codec::Wire wire_;
  SessionSettings settings_;
  codec::Framer framer_;
  Sample sample_;
  codec::State state_;
  JointArray raw_{}, zero_{}, turns_{}, span_{};  ///< span of a position that wraps; 0: it does not wrap
  std::array<Nanoseconds, kRateWindow> arrivals_{};
  std::array<uint64_t, kRateWindow> answered_{};  ///< how many reports had come before each of the last commands
  uint64_t reports_ = 0, bad_reports_ = 0;
  Nanoseconds good_at_ = 0, trouble_at_ = 0, healthy_at_ = 0;
  uint32_t last_sequence_ = 0, last_starts_ = 0, sent_ = 0, attached_at_ = 0;
  double last_clock_ = 0;
  bool clock_tells_ = false;  ///< the arm's clock differs from report to report
  bool attached_ = false, have_raw_ = false, calibrated_ = false, calibrate_ = false;
  codec::Verdict last_bad_ = codec::Verdict::kGood;
};

}  // namespace hapticd::wire_arm
