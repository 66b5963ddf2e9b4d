// SPDX-License-Identifier: MIT
#include "servo/safety/passivity/controller.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::passivity {

namespace {

constexpr double kSmoothing = 2.5e-3;  ///< [s] time constant of each of two stages that smooth the velocity: one
                                       ///< encoder count in a tick is not yet motion
constexpr double kRepayment = 5e-3;    ///< [s] time in which the damping must pay an energy debt back
constexpr double kRise = 5e-3;         ///< [s] rise time of the damping while there is a debt
/// [s] fall time of the damping once the debt is paid: longer than one period of a vibration that a hand feels
constexpr double kFall = 0.1;
constexpr double kMemory = 0.1;  ///< [s] time for which a debt is remembered after the contact

// These hold while a program pushes:
constexpr double kSteady = 0.1;  ///< [s] changes of force slower than this may give energy
/// [s] time in which the energy of swinging parts is forgotten, so that encoder counts do not add up to a vibration
constexpr double kSwingMemory = 0.5;
constexpr double kFirm = 1;       ///< [N] the work of this force over one encoder step is not yet a debt
constexpr double kPlay = 1.5;     ///< encoder steps to and fro that do not count as motion
constexpr double kLively = 0.02;  ///< [s] a probe that stays within kPlay for this time is at rest

double part(double dt, double time) noexcept {
  return std::min(1.0, dt / time);
}

}  // namespace

double stableDamping(double mass, double period) noexcept {
  return mass / (4 * std::max(period, 0.4 * kSmoothing));
}

void PassivityController::reset() noexcept {
  started_ = false;
  energy_ = swing_ = damping_ = 0;
  pushed_ = false;
  smoothed_.setZero();
  velocity_.setZero();
  share_ = 1;
  held_.setZero();
  added_.setZero();
}

Eigen::Vector3d PassivityController::update(const Eigen::Vector3d& position, const Eigen::Vector3d& force, double dt,
                                            const Exchange& exchange) noexcept {
  if (!position.allFinite() || !force.allFinite() || !(dt > 0)) {
    if (position.allFinite()) position_ = position;
    held_ = force.allFinite() ? force : Eigen::Vector3d::Zero();
    added_.setZero();
    started_ = position.allFinite();
    return force;  // a force that is not finite is returned too; the limiter ends it
  }
  const Eigen::Vector3d motion = started_ ? Eigen::Vector3d(position - position_) : Eigen::Vector3d::Zero();
  position_ = position;
  started_ = true;
  energy_ += device_damping_ * motion.squaredNorm() / dt - held_.dot(motion);
  dissipated_ -= added_.dot(motion);
  if (std::isfinite(exchange.supplied)) energy_ += share_ * exchange.supplied;
  if (exchange.recoverable >= 0) energy_ = std::min(energy_, exchange.recoverable);
  follow(moved(motion, dt, exchange.pushed), dt);
  recordSwing(motion, dt, exchange);
  if (!std::isfinite(energy_) || !std::isfinite(swing_) || !velocity_.allFinite()) reset();
  if (force.squaredNorm() == 0) leaveContact(dt);
  settle(force, dt);
  added_ = resistance(force);
  const Eigen::Vector3d result = force + added_;
  held_ = result;
  share_ = 1;
  return result;
}

void PassivityController::follow(const Eigen::Vector3d& motion, double dt) noexcept {
  const double share = part(dt, kSmoothing);
  smoothed_ += share * (motion / dt - smoothed_);
  velocity_ += share * (smoothed_ - velocity_);
}

/// Returns the part of `motion` that damping must resist. While a program pushes, encoder steps to and fro do
/// not count: the damping lags behind such a flicker, and would feed it instead of ending it.
Eigen::Vector3d PassivityController::moved(const Eigen::Vector3d& motion, double dt, bool pushed) noexcept {
  if (!pushed || (position_ - rest_).norm() > kPlay * resolution_) {
    rest_ = position_;
    lively_ = 1;
    return motion;
  }
  lively_ -= part(dt, kLively) * lively_;
  return lively_ * motion;
}

/// Keeps a second energy sum, of force and motion without their slow parts. The same high-pass filter acts on both, so
/// what is passive stays passive in this sum, and what creates energy by swinging creates it here too.
void PassivityController::recordSwing(const Eigen::Vector3d& motion, double dt, const Exchange& exchange) noexcept {
  if (!exchange.pushed || !pushed_) {
    if (pushed_) energy_ = std::max(energy_, swing_);  // after a push, only the debt of the swinging part remains
    swing_ = std::min(0.0, energy_);                   // a new push does not pay an earlier debt
    steady_ = held_;
    drift_ = velocity_;
    pushed_ = exchange.pushed;
    return;
  }
  const double share = part(dt, kSteady);
  steady_ += share * (held_ - steady_);
  drift_ += share * (motion / dt - drift_);
  const Eigen::Vector3d swung = motion - dt * drift_;
  swing_ += device_damping_ * swung.squaredNorm() / dt - (held_ - steady_).dot(swung);
  if (std::isfinite(exchange.supplied)) swing_ += share_ * exchange.supplied;
  swing_ *= 1 - part(dt, kSwingMemory);
}

/// Called without contact: a positive energy sum (a credit) is forgotten at once, but a negative one (a debt) is
/// remembered for a while, because a wall that throws the hand off and is met again at once is the vibration that must
/// end.
void PassivityController::leaveContact(double dt) noexcept {
  energy_ = std::min(0.0, energy_) * (1 - part(dt, kMemory));
  swing_ = std::min(0.0, swing_);
}

/// Raises the damping while there is a debt, and lowers it slowly once the debt is paid. If a debt were paid in one
/// tick, the hand would feel a blow each time the energy sum is one encoder count below zero.
void PassivityController::settle(const Eigen::Vector3d& force, double dt) noexcept {
  const double book = pushed_ ? std::max(energy_, swing_) : energy_, firm = pushed_ ? kFirm : 0;
  const double debt = -book - resolution_ * (force.norm() + firm), rate = kRepayment * velocity_.squaredNorm();
  const double wanted = debt <= 0 ? 0 : debt < max_damping_ * rate ? debt / rate : max_damping_;
  damping_ += part(dt, wanted > damping_ ? kRise : kFall) * (wanted - damping_);
}

/// Returns the damping force. It is never larger than the part of the force along the motion: it may cancel a push or
/// double a resistance, but it never reverses a force. So it is zero without a force, and a contact begins without a
/// step.
Eigen::Vector3d PassivityController::resistance(const Eigen::Vector3d& force) const noexcept {
  const double speed2 = velocity_.squaredNorm();
  if (!(speed2 > 0)) return Eigen::Vector3d::Zero();
  return -std::min(damping_, std::abs(force.dot(velocity_)) / speed2) * velocity_;
}

void PassivityController::applied(const Eigen::Vector3d& force) noexcept {
  if (!force.allFinite()) return;
  const double wanted = held_.norm();
  share_ = wanted > 0 ? std::min(1.0, force.norm() / wanted) : 1;
  added_ *= share_;
  held_ = force;
}

}  // namespace hapticd::passivity
