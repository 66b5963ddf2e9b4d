// SPDX-License-Identifier: MIT
/// Turns a sample into a probe: decides whether the sample can be trusted, where the tip is, and when forces may come
/// back.
#include <algorithm>
#include <array>
#include <cmath>

#include "servo/arm/arm.hpp"

namespace hapticd::servo {

namespace {

constexpr double kCalmFor = 0.5;      ///< [s] a device must be well for this time before its force comes back
constexpr double kCalmTravel = 0.02;  ///< [m] largest motion of the tip within kCalmFor, if a force would act on it
constexpr double kStaleAfter = 0.05;  ///< [s] after this time without a new sample, the position is too old for a force
/// [periods] without a new sample for this time, the force fades: one sample may be late
constexpr double kPeriodsTrusted = 2.001;
constexpr double kTrustFades = 2e-3;  ///< [s] duration of the fade of an old sample's force
constexpr double kPairWithin = 2e-3;  ///< [s] least time that counts between two samples, because they may arrive
                                      ///< closer together than they were measured

}  // namespace

/// Returns the share of a force that a sample of this age allows. An arm that sends no more samples keeps the last
/// force for at most two of its periods and 2 ms more. If its period is unknown, only a silence of 50 ms is noticed.
double Arm::trustIn(Nanoseconds age) const noexcept HSP_RT {
  if (sample_period_ <= 0) return 1;
  const double over = static_cast<double>(age) * kSecondsPerNanosecond - kPeriodsTrusted * sample_period_;
  return std::clamp(1 - over / kTrustFades, 0.0, 1.0);
}

const Probe& Arm::read(Nanoseconds now, double dt) noexcept HSP_RT {
  if (cut_.load()) {
    findCut(CutFound::kInRead);
    limiter_.cut(Fault::kStuck, cut_after_.load());
  }
  if (taken_.exchange(true)) {  // the watchdog is writing a zero force
    probe_.valid = tip_known_ = well_ = false;
    if (velocity_) velocity_->reset();
    return probe_;
  }
  read_status_ = device_->read(now, sample_);
  taken_.store(false);
  const bool sampled = read_status_ >= 0 && (sample_.flags & HDV_S_LOST) == 0;
  // Before the first report the buttons are unknown.
  const bool reported = sampled && (sample_.sequence > 0 || as_found_);
  limiter_.watchButtons(reported ? std::optional(sample_.buttons) : std::nullopt);
  found_pressed_.store(limiter_.foundPressed(), std::memory_order_relaxed);
  probe_.valid = checkSample(read_status_, now) && locate();
  if (!probe_.valid) {
    tip_known_ = false;
    if (velocity_) velocity_->reset();
    return probe_;
  }
  watchJump();
  if (admittance_) takeVirtualProbe(*admittance_);
  // A device slower than the servo repeats its sample. The estimator gets only new samples: a repeated one would look
  // like rest, and the next new one like several times the speed of the hand. A virtual mass moves in every tick.
  if (velocity_ && (fresh_ || admittance_)) {
    probe_.velocity = velocity_->update(probe_.position, admittance_ ? dt : measured_after_);
    limiter_.watchVelocity(probe_.velocity);
    if (velocity_->speed() > kMaxProbeSpeed) limiter_.watchSpeed(velocity_->speed());
  }
  return probe_;
}

bool Arm::checkSample(hsp_status status, Nanoseconds now) noexcept HSP_RT {
  well_ = false;
  if (status < 0 || (sample_.flags & HDV_S_LOST) != 0) {
    trip(Fault::kDeviceLost);
    return false;
  }
  const bool at_fault = (sample_.flags & HDV_S_FAULT) != 0;
  if (at_fault) trip(Fault::kDeviceFault);
  const bool lacks_zero =
      (device_->info().capabilities & HDV_C_CALIBRATION) != 0 && (sample_.flags & HDV_S_CALIBRATED) == 0;
  if (lacks_zero) limiter_.trip(Fault::kNotCalibrated);
  fresh_ = sample_.sequence != last_sequence_;
  if (fresh_) {
    last_sequence_ = sample_.sequence;
    fresh_after_ = static_cast<double>(now - fresh_at_) * kSecondsPerNanosecond;
    fresh_at_ = now;
    measured_after_ = interval_.update(sample_.time_ns, fresh_after_);
  } else if (static_cast<double>(now - fresh_at_) * kSecondsPerNanosecond > kStaleAfter) {
    trip(Fault::kStale, static_cast<double>(now - fresh_at_) * kSecondsPerNanosecond);
    return false;
  }
  for (uint32_t i = 0; i < device_->info().joint_count; ++i) {
    if (std::isfinite(sample_.position[i])) continue;
    limiter_.trip(Fault::kNotFinite);
    return false;
  }
  well_ = !at_fault && !lacks_zero;
  return true;
}

void Arm::trip(Fault fault, double measured) noexcept HSP_RT {
  if (limiter_.fault() == Fault::kNone) trouble_.store(device_->trouble(), std::memory_order_release);
  limiter_.trip(fault, measured);
}

/// Gives the force back to a device that was unplugged, silent or at fault. The device must have worked for a while,
/// and the force must surprise nobody: the tip must rest, or no force may act on it now.
void Arm::recover(double dt, bool pushes) noexcept HSP_RT {
  const bool moved = pushes && !((probe_.position - calm_at_).norm() <= kCalmTravel);
  if (!well_ || !probe_.valid || moved || !limiter_.silent()) {
    calm_ = 0;
    calm_at_ = probe_.position;
    return;
  }
  calm_ += dt;
  if (calm_ >= kCalmFor) limiter_.recover();
}

bool Arm::locate() noexcept HSP_RT {
  Eigen::Vector3d p_device;
  std::array<double, 4> q{1, 0, 0, 0};
  const hdv_ext_kinematics& kinematics = device_->kinematics();
  const bool known = kinematics.forward(device_->handle(), sample_.position, p_device.data(), q.data()) >= 0;
  if (!known || !p_device.allFinite() || !Eigen::Map<const Eigen::Vector4d>(q.data()).allFinite()) {
    limiter_.trip(Fault::kNotFinite);
    return false;
  }
  constexpr double kUnit = 1e-3;
  const double length = Eigen::Map<const Eigen::Vector4d>(q.data()).norm();
  if (!(std::abs(length - 1) <= kUnit)) {
    limiter_.trip(Fault::kNotUnit, length);
    return false;
  }
  probe_.position = R_world_device_ * p_device + origin_world_;
  probe_.orientation = q_world_device_ * quaternionOf(q.data());
  return true;
}

/// Trips a fault if the tip moved farther between two samples than a hand can move it: an encoder lost its count, or a
/// packet was misread. While the force is off anyway, a device may find its zero or its position again.
void Arm::watchJump() noexcept HSP_RT {
  if (!watches_jumps_ || !fresh_) return;
  const double jumped = (probe_.position - tip_).norm() / std::max(fresh_after_, kPairWithin);
  if (!tip_known_) sample_speed_.reset();
  const double speed = sample_speed_.update(probe_.position, sample_.time_ns, fresh_after_);
  const bool felt = limiter_.fault() == Fault::kNone;
  if (felt && tip_known_ && !(jumped <= kMaxProbeSpeed)) limiter_.trip(Fault::kJumped, jumped);
  if (felt && tip_known_ && fastest_ > 0 && !(speed <= fastest_)) limiter_.trip(Fault::kTooFast, speed);
  tip_known_ = felt;
  tip_ = probe_.position;
}

}  // namespace hapticd::servo
