// SPDX-License-Identifier: MIT
#include "servo/safety/limiter.hpp"

#include <algorithm>

namespace hapticd::servo {

namespace {

using Eigen::Vector3d;

/// A share of a ramp smaller than this is a rounding error: a fade must end exactly at zero, and in time.
constexpr double kRounding = 1e-9;

double rampedUp(double now, double dt, double seconds) noexcept HSP_RT {
  return seconds > dt ? std::min(1.0, now + dt / seconds) : 1.0;
}

double rampedDown(double now, double dt, double seconds) noexcept HSP_RT {
  const double next = seconds > dt ? now - dt / seconds : 0.0;
  return next > kRounding ? next : 0.0;
}

bool cap(Vector3d& v, double most) noexcept HSP_RT {
  const double norm = v.norm();
  if (norm <= most) return false;
  v *= most / norm;
  return true;
}

/// Bounds how fast a force grows and turns. A force may always shrink: a force that a shape no longer gives is never
/// held. @param slow a force that follows the sent one at the limit @return true if the force was reduced
bool limitSlew(Vector3d& v, const Vector3d& slow, double most) noexcept HSP_RT {
  const double asked = v.norm();
  const Vector3d change = v - slow;
  const double size = change.norm();
  if (size <= most) return false;
  v = slow + change * (most / size);
  return !cap(v, asked);
}

/// Moves `slow` toward the last force by `slew` [N/s]. It never stays farther behind than the slew covers in the rest
/// of the window.
void follow(Vector3d& slow, const Vector3d& last, double slew, double dt) noexcept HSP_RT {
  const Vector3d behind = slow - last;
  const double size = behind.norm(), rest = slew * std::max(0.0, Limiter::kSlewWindow - dt);
  const double kept = std::clamp(size - slew * dt, 0.0, rest);
  slow = last;
  if (kept > 0) slow += behind * (kept / size);
}

}  // namespace

const char* nameOf(Limit limit) {
  static constexpr const char* kNames[kLimitCount] = {"workspace", "motors (heat)",    "force", "torque",
                                                      "power",     "impulse",          "slew",  "motors (torque)",
                                                      "weight",    "age of the sample"};
  return kNames[static_cast<size_t>(limit)];
}

const char* keyOf(Limit limit) {
  static constexpr const char* kKeys[kLimitCount] = {
      "limits.workspace", "limits.motors", "limits.force",   "limits.torque", "limits.power",
      "limits.impulse",   "limits.slew",   "arm.max_torque", "limits.weight", "age of the sample"};
  return kKeys[static_cast<size_t>(limit)];
}

Limiter::Limiter(const scene::Limits& limits, double device_max_force)
    : limits_(limits), max_force_(limits.force > 0 ? limits.force : device_max_force), enabled_(!limits.enable.button) {
  if (limits.force > 0 && device_max_force > 0) max_force_ = std::min(limits.force, device_max_force);
}

void Limiter::apply(Vector3d& force, Vector3d& torque, const Vector3d& position, double dt) noexcept HSP_RT {
  if (!force.allFinite() || !torque.allFinite() || !position.allFinite()) {
    trip(Fault::kNotFinite);
    force.setZero();
    torque.setZero();
  }
  clipped_ = false;
  power_.pass(dt);
  // The motors held the last force until now, however late this tick is.
  const double held = std::min(dt, kImpulseWindow);
  impulse_ += (last_force_.norm() - impulse_ / kImpulseWindow) * held;
  const double grows = std::min(dt, period_);
  if (limits_.slew > 0) follow(slow_force_, last_force_, limits_.slew, grows);
  if (limits_.torque_slew > 0) follow(slow_torque_, last_torque_, limits_.torque_slew, grows);
  if (fault() != Fault::kNone) {
    // Fades the last force, because the new one may be the fault itself.
    fade_ = rampedDown(fade_, dt, faultRamp());
    force = fade_ * fault_force_;
    torque = fade_ * fault_torque_;
    if (fade_ == 0 && cleared_) clear();
  } else {
    ramp(force, torque, dt);
    limit(force, torque, position, dt);
  }
  last_force_ = force;
  last_torque_ = torque;
}

/// Returns the duration [s] of the ramp to zero after a fault; it is longer for a planned end.
double Limiter::faultRamp() const noexcept HSP_RT {
  return fault() == Fault::kStopped ? limits_.ramp_out : std::min(limits_.ramp_out, kFaultRamp);
}

void Limiter::ramp(Vector3d& force, Vector3d& torque, double dt) noexcept HSP_RT {
  ramp_ =
      enabled_ ? rampedUp(ramp_, dt, limits_.ramp_in) : rampedDown(ramp_, dt, std::min(limits_.ramp_out, kFaultRamp));
  fresh_ = std::min(trusted_, rampedUp(fresh_, dt, kFreshRamp));
  if (fresh_ < 1 && !(force.isZero(0) && torque.isZero(0))) count(Limit::kSample);
  force *= ramp_ * fresh_;
  torque *= ramp_ * fresh_;
  if (enabled_) return;
  cap(force, last_force_.norm());  // while the switch is released, no force grows
  cap(torque, last_torque_.norm());
}

void Limiter::limit(Vector3d& force, Vector3d& torque, const Vector3d& position, double dt) noexcept HSP_RT {
  const bool pushes = !force.isZero(0) || !torque.isZero(0);
  const double near = workspaceFade(position);
  force *= near * heat_factor_;
  torque *= near * heat_factor_;
  if (pushes && near < 1) count(Limit::kWorkspace);
  if (pushes && heat_factor_ < 1) count(Limit::kHeat);
  // A shape may ask for many times the limit, for example if a tip begins inside a model, so the limit ramps as well.
  const double share = ramp_ * fresh_;
  if (max_force_ > 0 && cap(force, max_force_ * share)) count(Limit::kForce);
  if (limits_.torque > 0 && cap(torque, limits_.torque * share)) count(Limit::kTorque);
  if (limits_.impulse > 0) limitImpulse(force, dt);
  const double window = std::max(std::min(dt, period_), kSlewWindow);
  if (limits_.slew > 0 && limitSlew(force, slow_force_, limits_.slew * window)) count(Limit::kSlew);
  if (limits_.torque_slew > 0 && limitSlew(torque, slow_torque_, limits_.torque_slew * window)) count(Limit::kSlew);
  if (limits_.power > 0) limitPower(force);  // after the slew limit, which may turn the force
}

void Limiter::limitPower(Vector3d& force) noexcept HSP_RT {
  // [N]; only power from the arm to the hand is limited
  const double asked = force.norm();
  if (asked > 0 && cap(force, power_.most(force / asked, limits_.power))) count(Limit::kPower);
}

void Limiter::limitImpulse(Vector3d& force, double dt) noexcept HSP_RT {
  // impulse_ is a leaky integrator with the window as its time constant. The impulse of any window is at most what the
  // integrator holds at the end plus what leaked meanwhile, so at most twice its largest value. So half the limit as
  // the largest value bounds every window, wherever it begins. The cap falls as the integrator fills, so that a held
  // force settles at size / window without a step.
  constexpr double kApproach = 0.01;  // [s] the impulse that is left may be used up in this time
  const double size = limits_.impulse / 2, booked = std::min(impulse_, size);
  const double most = (size - booked) / std::max(kApproach, dt) + booked / kImpulseWindow;
  if (cap(force, most)) count(Limit::kImpulse);
}

double Limiter::workspaceFade(const Vector3d& position) const noexcept HSP_RT {
  constexpr double kFadeWidth = 0.02;  // [m] distance beyond the limit over which the force fades to zero
  if (limits_.workspace <= 0) return 1;
  return std::clamp(1 - (position.norm() - limits_.workspace) / kFadeWidth, 0.0, 1.0);
}

void Limiter::count(Limit limit) noexcept HSP_RT {
  ++clips_.ticks[static_cast<size_t>(limit)];
  if (!clipped_) ++clips_.any;
  clipped_ = true;
}

void Limiter::watchSpeed(double speed) noexcept HSP_RT {
  const double most = limits_.velocity.value_or(0);
  if (most > 0 && !(speed <= most)) trip(Fault::kTooFast, speed);
}

void Limiter::watchVelocity(const Vector3d& velocity) noexcept HSP_RT {
  watchSpeed(velocity.norm());
  power_.watch(velocity);
}

void Limiter::watchButtons(std::optional<uint32_t> buttons) noexcept HSP_RT {
  if (!limits_.enable.button) return;
  if (!buttons) {  // a toggle keeps its state: a button held across bad samples is not a new press
    if (limits_.enable.mode == scene::EnableMode::kHold) enabled_ = false;
    return;
  }
  const bool down = ((*buttons >> *limits_.enable.button) & 1u) != 0;
  released_ |= !down;
  found_pressed_ = !released_;
  if (limits_.enable.mode == scene::EnableMode::kHold) {
    enabled_ = down && released_;
  } else if (down && !button_was_down_) {
    enabled_ = !enabled_;
  }
  button_was_down_ = down;
}

void Limiter::trip(Fault fault, double measured) noexcept HSP_RT {
  const Fault before = fault_.get();
  if (fault != Fault::kNone) cleared_ = false;  // the user has not cleared this fault
  if (fault == Fault::kNone || (before != Fault::kNone && (endsByItself(fault) || !endsByItself(before)))) return;
  measured_ = measured;
  faults_ += fault == Fault::kStopped ? 0 : 1;
  if (before != Fault::kNone) return fault_.set(fault);  // the force ramps down already
  fade_ = 1;
  fault_force_ = last_force_;
  fault_torque_ = last_torque_;
  fault_.set(fault);
}

void Limiter::cut(Fault fault, double measured) noexcept HSP_RT {
  trip(fault, measured);
  sentNothing();
}

void Limiter::sentNothing() noexcept HSP_RT {
  if (fault() != Fault::kNone) fade_ = 0;
  last_force_.setZero();
  last_torque_.setZero();
}

void Limiter::recover() noexcept HSP_RT {
  if (!endsByItself(fault())) return;
  recovered_.set(fault());
  clear();
}

void Limiter::clear() noexcept HSP_RT {
  cleared_ = fade_ > 0;
  if (cleared_) return;  // apply() calls this again once the force is zero
  fault_.set(Fault::kNone);
  ramp_ = 0;
}

}  // namespace hapticd::servo
