// SPDX-License-Identifier: MIT
/// Turns the reports of one arm into samples, and the host's torques into commands. A command has torques only if both
/// the arm and the host are healthy. Bytes and time are arguments, so that tests can replay every fault in virtual
/// time.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "base/clock.hpp"
#include "codec/framer.hpp"
#include "codec/report.hpp"
#include "codec/wire.hpp"
#include "wire_arm/trouble.hpp"

namespace hapticd::wire_arm {

using JointArray = std::array<double, codec::kMaxJoints>;

/// Bounds beyond which an arm counts as unhealthy, and the times of its recovery.
struct HealthLimits {
  double stale = 0.015;       ///< [s] longest time without a good report
  double host_silent = 0.02;  ///< [s] longest time without a command of the host; then the motors go off
  double least_rate = 0.57;   ///< least rate of reports, as a share of wire.rate, over kRateWindow reports; 0: no check
  double recovery = 0.2;      ///< [s] time of good reports after which a trouble is over
  double ramp = 0.25;         ///< [s] time from zero torque to full torque after a trouble
  double max_speed = 100;     ///< [rad/s] largest speed of a joint; a faster change is a jump of its encoder
};

/// How an arm gets absolute positions.
enum class Calibration : uint8_t {
  kNone,    ///< its encoders are absolute
  kDevice,  ///< the arm finds its zero by itself (index pulse, homing) and reports it
  kPose,    ///< the user holds the arm in a known pose (inkwell, stop)
};

struct SessionSettings {
  size_t joints = 3;
  Calibration calibration = Calibration::kNone;
  HealthLimits health;
};

/// One sample for the servo thread. Positions are in rad or m.
struct Sample {
  Nanoseconds time = 0;
  uint64_t sequence = 0;
  uint32_t buttons = 0;
  bool calibrated = false;
  Trouble trouble = Trouble::kStale;
  JointArray position{}, velocity{}, torque{};
};

/// One command of the servo thread.
struct ArmCommand {
  Nanoseconds time = 0;
  uint64_t sequence = 0;            ///< grows with every write
  bool on = false, follow = false;  ///< on: motors on; follow: `position` holds references in addition to the torques
  JointArray torque{}, position{};
};

class Session {
 public:
  Session(const codec::Wire& wire, const SessionSettings& settings);

  /// [any] To be called when the device was opened and started. @param zero offsets [rad or m] to add to positions
  /// @param calibrated true if `zero` is valid
  void attach(Nanoseconds now, const JointArray& zero, bool calibrated) noexcept;
  /// [any] To be called when the transport failed.
  void lose(Nanoseconds now, Trouble trouble) noexcept;
  /// [any] Takes one transfer. Returns true if sample() has changed: a new report came, or a trouble began.
  bool receive(Nanoseconds now, std::span<const uint8_t> bytes) noexcept;
  /// [any] Checks the time since the last good report, and the rate of the reports. Returns true if the trouble
  /// changed.
  bool watch(Nanoseconds now) noexcept;

  /// [any] Writes the next command to `bytes` and returns its number of bytes. The command has torques only if the arm
  /// is healthy and the command is not older than HealthLimits::host_silent.
  size_t command(Nanoseconds now, const ArmCommand& wanted, std::span<uint8_t> bytes) noexcept;

  const Sample& sample() const noexcept { return sample_; }
  Trouble trouble() const noexcept { return sample_.trouble; }
  /// While `wanted` is true, the commands tell the arm to find its zero.
  void calibrateByDevice(bool wanted) noexcept { calibrate_ = wanted; }
  /// Sets the offsets [rad or m] that are added to positions. The arm counts as calibrated from now on.
  void setZero(const JointArray& zero) noexcept;
  /// Returns the positions before the zero offsets are added. The full turns of positions that wrap are included.
  const JointArray& raw() const noexcept { return raw_; }
  uint64_t badReports() const noexcept { return bad_reports_; }

  static constexpr size_t kRateWindow = 10;

 private:
  /// The arrival of a good report.
  struct Arrival {
    Nanoseconds at = 0;
    uint64_t bad = 0;  ///< number of bad reports before it
  };

  bool take(Nanoseconds now, std::span<const uint8_t> bytes) noexcept;
  bool follow(Nanoseconds now, const codec::State& state) noexcept;
  void reject(Nanoseconds now, codec::Verdict verdict) noexcept;
  void recover(Nanoseconds now) noexcept;
  double gain(Nanoseconds now, bool healthy) noexcept;
  bool tooSlow(Nanoseconds now) noexcept;
  double longGap() const noexcept;
  double longGapHere() const noexcept;
  Trouble whatComes(Nanoseconds since) const noexcept;
  void raise(Nanoseconds now, Trouble trouble) noexcept;
  void publish(Nanoseconds now, const codec::State& state) noexcept;
  bool startedAnew(Nanoseconds now) noexcept;
  bool again() const noexcept;
  bool lostCounts() const noexcept;

  codec::Wire wire_;
  SessionSettings settings_;
  codec::Framer framer_;
  Sample sample_;
  codec::State state_;
  JointArray raw_{}, zero_{}, turns_{}, span_{};  ///< span_: range after which a position wraps, 0 if it does not wrap
  JointArray lost_{};                             ///< sum of the jumps of each joint since it had its zero
  double sequence_cycle_ = 0, clock_cycle_ = 0;   ///< numbers of reports begin anew after so much; clock: [s]
  std::array<Arrival, kRateWindow> arrivals_{};
  std::array<uint64_t, kRateWindow> answered_{};  ///< number of reports before each of the last commands
  uint64_t reports_ = 0, bad_reports_ = 0;
  Nanoseconds good_at_ = 0, bad_at_ = 0, old_at_ = 0, trouble_at_ = 0, healthy_at_ = 0, zeroless_at_ = 0;
  Nanoseconds named_at_ = 0;  ///< when the last bad report came that is of the kind of the present trouble; 0: none
  uint32_t last_sequence_ = 0, last_starts_ = 0, sent_ = 0, attached_at_ = 0;
  double last_clock_ = 0;
  bool clock_tells_ = false;  ///< the arm's clock has a new value in each report
  bool attached_ = false, have_raw_ = false, calibrated_ = false, calibrate_ = false;
  Trouble last_bad_ = Trouble::kNone;  ///< what the last bad report says
};

}  // namespace hapticd::wire_arm
