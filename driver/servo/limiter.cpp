#include "servo/limiter.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

const char* describe(Fault fault) {
  switch (fault) {
    case Fault::kNone:
      return "no fault";
    case Fault::kNotFinite:
      return "a force or position was not a number; restart after looking at the plugin or device named";
    case Fault::kDeviceLost:
      return "the device is gone; plug it in again: hapticd device list";
    case Fault::kDeviceFault:
      return "the device reports a hardware fault; switch it off and on, then: hapticd device info FILE";
    case Fault::kStale:
      return "the device sent no new sample; check its cable and rate: hapticd device info FILE";
    case Fault::kTooFast:
      return "the tip moved faster than limits.velocity; hold the arm, then start again";
    case Fault::kLate:
      return "too many ticks were missed in a row; look for the cause with: hapticd doctor";
    case Fault::kNotCalibrated:
      return "the device is not calibrated; run: hapticd device calibrate FILE";
    case Fault::kStopped:
      return "stopped by the user";
  }
  return "unknown fault";
}

Limiter::Limiter(const scene::Limits& limits, double device_max_force)
    : limits_(limits), max_force_(limits.force > 0 ? limits.force : device_max_force) {
  if (limits.force > 0 && device_max_force > 0) max_force_ = std::min(limits.force, device_max_force);
}

void Limiter::apply(Eigen::Vector3d& force, Eigen::Vector3d& torque, const Eigen::Vector3d& position,
                    double dt) noexcept HSP_RT {
  if (!force.allFinite() || !torque.allFinite() || !position.allFinite()) {
    trip(Fault::kNotFinite);
    force.setZero();
    torque.setZero();
  }
  if (fault_ != Fault::kNone) {
    // Fade along the last force: the new one may be the fault itself.
    fade_ = limits_.ramp_out > dt ? std::max(0.0, fade_ - dt / limits_.ramp_out) : 0.0;
    force = fade_ * fault_force_;
    torque = fade_ * fault_torque_;
  } else {
    ramp_ = limits_.ramp_in > dt ? std::min(1.0, ramp_ + dt / limits_.ramp_in) : 1.0;
    const double part = ramp_ * workspaceFade(position);
    force *= part;
    torque *= part;
    if (max_force_ > 0 && force.norm() > max_force_) force *= max_force_ / force.norm();
    if (limits_.torque > 0 && torque.norm() > limits_.torque) torque *= limits_.torque / torque.norm();
    const Eigen::Vector3d change = force - last_force_;
    const double most = limits_.slew * dt;
    if (limits_.slew > 0 && change.norm() > most) force = last_force_ + change * (most / change.norm());
  }
  last_force_ = force;
  last_torque_ = torque;
}

double Limiter::workspaceFade(const Eigen::Vector3d& position) const noexcept HSP_RT {
  constexpr double kFadeWidth = 0.02;  // [m] over which the force fades beyond the limit
  if (limits_.workspace <= 0) return 1;
  return std::clamp(1 - (position.norm() - limits_.workspace) / kFadeWidth, 0.0, 1.0);
}

void Limiter::watchSpeed(double speed) noexcept HSP_RT {
  if (limits_.velocity > 0 && !(speed <= limits_.velocity)) trip(Fault::kTooFast);
}

void Limiter::trip(Fault fault) noexcept HSP_RT {
  if (fault_ != Fault::kNone || fault == Fault::kNone) return;
  fault_ = fault;
  fade_ = 1;
  fault_force_ = last_force_;
  fault_torque_ = last_torque_;
}

void Limiter::clear() noexcept HSP_RT {
  fault_ = Fault::kNone;
  ramp_ = 0;
}

}  // namespace hapticd::servo
