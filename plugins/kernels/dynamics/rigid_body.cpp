// SPDX-License-Identifier: MIT
#include "kernels/dynamics/rigid_body.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernels/dynamics/contact_step.hpp"
#include "kernels/dynamics/mass_properties.hpp"
#include "kernels/dynamics/oscillator.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kLargestTurn = 0.15;  // [rad] largest turn in a substep
// most substeps, to bound the time of a tick; a faster body is less accurate, but stable
constexpr int kBodySubsteps = 4;

/// Advances the position under a constant force exactly: x'' = (force - b x' - k x)/m.
void drive(double mass, double damping, double stiffness, const Vector3d& force, double dt, Vector3d& x, Vector3d& v) {
  if (stiffness > 0) {
    const Vector3d rest = force / stiffness;
    Vector3d from_rest = x - rest;
    advance(oscillatorStep(mass, damping, stiffness, dt), from_rest, v);
    x = rest + from_rest;
    return;
  }
  const double c = damping / mass;
  const double phi = c * dt > 1e-12 ? -std::expm1(-c * dt) / c : dt;
  const double drift = c * dt > 1e-4 ? (dt - phi) / c : dt * dt / 2 * (1 - c * dt / 3);
  x += phi * v + drift / mass * force;
  v += phi * (force / mass - c * v);
}

void validate(const RigidBodyLaw& law) {
  if (!(law.mass > 0) || !std::isfinite(law.mass)) throw std::invalid_argument("mass: must be above 0 kg, and finite");
  if (!law.center.allFinite()) throw std::invalid_argument("center: must be three finite numbers");
  principalMoments(law.inertia);
  if (!(law.damping >= 0) || !(law.angular_damping >= 0) || !(law.tether >= 0))
    throw std::invalid_argument("drag, angular_drag and tether must be 0 or more");
  if (!(law.angular_tether >= 0) || !std::isfinite(law.angular_tether) || !std::isfinite(law.rest))
    throw std::invalid_argument("angular_tether must be 0 or more, and rest a finite number");
  validate(law.limits);
  if (law.joint == Joint::kFree && law.limits.given())
    throw std::invalid_argument(
        "limits: a free body has no axis along which a stop could hold it; "
        "expected joint: hinge or slider beside limits");
  if (law.joint != Joint::kFree && !(law.axis.norm() > 0))
    throw std::invalid_argument("axis: all three numbers are 0, so it has no direction; give one such as [0, 1, 0]");
}

}  // namespace

RigidBody::RigidBody(const RigidBodyLaw& law, const Vector3d& position, const Quaterniond& orientation,
                     const Vector3d& gravity)
    : law_(law), gravity_(gravity) {
  validate(law);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(law.inertia);
  principal_ = solver.eigenvalues();
  Matrix3d axes = solver.eigenvectors();
  if (law.inertia.isDiagonal(0)) {  // this keeps the order of the axes in which the user gave the moments
    principal_ = law.inertia.diagonal();
    axes.setIdentity();
  }
  if (axes.determinant() < 0) axes.col(0) *= -1;
  from_axes_ = Quaterniond(axes);
  top_ = Top(principal_);
  const Quaterniond model = orientation.normalized();
  turn_.set(model * from_axes_);
  x_ = start_ = position + model * law.center;
  pivot_world_ = position + model * law.pivot;
  axis_world_ = law.joint == Joint::kFree ? Vector3d::UnitY() : Vector3d(model * law.axis.normalized());
  anchor_ = law.joint == Joint::kSlider ? Vector3d(start_ + law.rest * axis_world_) : start_;
  if (law.joint == Joint::kHinge) initializeHinge();
  start_turn_ = turn_.quaternion();
}

void RigidBody::step(const Vector3d& force, const Vector3d& torque, double dt) noexcept {
  if (!(dt > 0) || !std::isfinite(dt)) return;
  const Vector3d pushed = force.allFinite() ? force : Vector3d::Zero().eval();
  const Vector3d t = torque.allFinite() ? torque : Vector3d::Zero().eval();
  if (law_.joint == Joint::kHinge) return stepHinge(pushed, t, dt);
  const Vector3d f = pushed + law_.mass * gravity_;
  if (law_.joint == Joint::kSlider) {
    translate(axis_world_ * axis_world_.dot(f), dt);
    return stopSlider();
  }
  translate(f, dt);
  rotate(t, dt);
}

namespace {

/// Returns the torsional stiffness [N m/rad] of a contact whose normal turns with the body, and which turns the body
/// back to face the probe. If the contact would turn the body over instead (a press from behind the centre), the
/// stiffness is 0.
Matrix3d facing(const PredictedContact& press, const Vector3d& lever) noexcept {
  const double push = std::max(0.0, -press.outward.dot(press.force)) * std::max(0.0, press.outward.dot(lever));
  return push * (Matrix3d::Identity() - press.outward * press.outward.transpose());
}

}  // namespace

/// Returns weight, drag and spring on the centre of mass [N], as they are after dt [s] if it keeps its velocity.
Vector3d RigidBody::ownForce(double dt) const noexcept {
  return law_.mass * gravity_ - law_.damping * v_ - law_.tether * (x_ - anchor_ + dt * v_);
}

Balance<6> RigidBody::own(const FreeMotion&, double dt) const noexcept {
  Balance<6> own;
  const Matrix3d axes = turn_.matrix();
  own.resistance.topLeftCorner<3, 3>().diagonal().setConstant(law_.mass + dt * law_.damping + dt * dt * law_.tether);
  own.resistance.bottomRightCorner<3, 3>() = axes * principal_.asDiagonal() * axes.transpose();
  own.resistance.bottomRightCorner<3, 3>().diagonal().array() += dt * law_.angular_damping;
  own.impulse << ownForce(dt), -law_.angular_damping * angular();
  own.impulse *= dt;
  return own;
}

Balance<1> RigidBody::own(const JointMotion& joint, double dt) const noexcept {
  const Vector3d way = joint.at(x_);
  double resistance = jointInertia() + dt * (law_.damping + dt * law_.tether) * way.squaredNorm();
  double force = way.dot(ownForce(dt));
  if (joint.turns) {
    resistance += dt * (law_.angular_damping + dt * law_.angular_tether);
    force -= law_.angular_damping * hinge_rate_ + law_.angular_tether * (hinge_angle_ + dt * hinge_rate_ - law_.rest);
  }
  return {Eigen::Matrix<double, 1, 1>(resistance), Vector1d(dt * force)};
}

template <class Motion>
void RigidBody::stepUnder(std::span<const PredictedContact> presses, const Motion& motion, double dt) noexcept {
  auto balance = own(motion, dt);
  for (const PredictedContact& press : presses) {
    // also if the contact does not act in the end: whether it acts must not depend on the resistance that it adds
    const Matrix3d back = dt * dt * facing(press, press.point - x_);
    motion.addTurn(balance, back, -back * angular());
  }
  const ContactStep<Motion> step(motion, balance, presses, dt);
  const auto change = step.change();
  step.touched(change) && change.allFinite() ? drift(change, dt) : this->step(Vector3d::Zero(), Vector3d::Zero(), dt);
}

void RigidBody::step(std::span<const PredictedContact> presses, double dt) noexcept {
  if (presses.empty() || !(dt > 0)) return step(Vector3d::Zero(), Vector3d::Zero(), dt);
  if (law_.joint == Joint::kFree) return stepUnder(presses, FreeMotion{x_}, dt);
  stepUnder(presses, JointMotion{law_.joint == Joint::kHinge, axis_world_, pivot_world_}, dt);
}

/// Makes the second half of a backward Euler step: sets the velocity at the end of the step, and moves the body with
/// this velocity. So a body that rests on a probe has no velocity.
void RigidBody::drift(const Vector6d& change, double dt) noexcept {
  v_ += change.head<3>();
  x_ += dt * v_;
  const Matrix3d axes = turn_.matrix();
  l_ += axes * principal_.cwiseProduct(axes.transpose() * change.tail<3>());
  // Backward Euler is of first order, so a more accurate turn would only cost time.
  turn_.turnBody(top_.roughBodyTurn(turn_.quaternion().conjugate() * l_, dt));
  turn_.turnWorld(dt * top_.worldRate() * l_);
}

void RigidBody::drift(const Vector1d& change, double dt) noexcept {
  if (law_.joint == Joint::kHinge) {
    hinge_rate_ += change.value();
    return poseHinge(hinge_angle_ + dt * hinge_rate_);
  }
  v_ += change.value() * axis_world_;
  x_ += dt * v_;
  stopSlider();
}

Vector3d RigidBody::velocityAt(const Vector3d& point) const noexcept {
  return v_ + angular().cross(point - x_);
}

void RigidBody::translate(const Vector3d& force, double dt) noexcept {
  Vector3d away = x_ - anchor_;
  drive(law_.mass, law_.damping, law_.tether, force, dt, away, v_);
  x_ = anchor_ + away;
}

void RigidBody::stopSlider() noexcept {
  if (!law_.limits.given()) return;
  double way = jointPosition(), rate = axis_world_.dot(v_);
  if (holdInRange(law_.limits, way, rate) == Stop::kNone) return;
  x_ = start_ + way * axis_world_;
  v_ = rate * axis_world_;
}

void RigidBody::rotate(const Vector3d& torque, double dt) noexcept {
  l_ += dt / 2 * torque;
  decay(dt / 2);
  spin(dt);
  decay(dt / 2);
  l_ += dt / 2 * torque;
}

/// Turns the body for dt [s] without torque.
void RigidBody::spin(double dt) noexcept {
  const double turn = top_.symmetric() ? 0 : top_.bodyRate() * l_.norm() * dt;
  const int steps = turn < kBodySubsteps * kLargestTurn ? 1 + static_cast<int>(turn / kLargestTurn) : kBodySubsteps;
  for (int i = 0; i < steps; ++i) {
    turn_.turnBody(top_.bodyTurn(turn_.quaternion().conjugate() * l_, dt / steps));
  }
  turn_.turnWorld(dt * top_.worldRate() * l_);  // this turn does not change the momentum as seen from the body
}

/// Applies angular drag: the momentum about each principal axis decays separately.
void RigidBody::decay(double time) noexcept {
  if (!(law_.angular_damping > 0)) return;
  const Quaterniond& q = turn_.quaternion();
  const Vector3d left = (-law_.angular_damping * time * principal_.cwiseInverse()).array().exp();
  l_ = q * left.cwiseProduct(q.conjugate() * l_);
}

void RigidBody::stepHinge(const Vector3d& force, const Vector3d& torque, double dt) noexcept {
  const double moment = axis_world_.dot(torque + (x_ - pivot_world_).cross(force));
  const PendulumState now{hinge_angle_ - hinge_rest_, hinge_rate_};
  const TorsionSpring spring{law_.angular_tether, law_.rest - hinge_rest_};
  const PendulumState next =
      spring.stiffness > 0 ? advance(hinge_, spring, now, moment, dt) : advance(hinge_, now, moment, dt);
  hinge_rate_ = next.rate;
  poseHinge(next.angle + hinge_rest_);
}

void RigidBody::poseHinge(double angle) noexcept {
  // the remainder keeps the precision of a body that goes round many times
  hinge_angle_ = counts_turns_ ? angle : std::remainder(angle, 2 * M_PI);
  holdInRange(law_.limits, hinge_angle_, hinge_rate_);
  // the pose is computed from the angle since the start, not step by step, so it has only the error of the angle
  const Quaterniond turn = rotationBy(hinge_angle_ * axis_world_);
  turn_.set(turn * start_turn_);
  x_ = pivot_world_ + turn * (start_ - pivot_world_);
  setHingeVelocities();
}

/// Sets up the hinge as a pendulum: weight and tether pull the centre of mass, on its circle, toward one lowest point.
void RigidBody::initializeHinge() noexcept {
  const Vector3d out = (start_ - pivot_world_) - axis_world_ * axis_world_.dot(start_ - pivot_world_);
  const double down = law_.tether * out.squaredNorm() + law_.mass * gravity_.dot(out);
  const double aside = law_.mass * gravity_.dot(axis_world_.cross(out));
  const Vector3d axis = law_.axis.normalized();
  counts_turns_ = law_.angular_tether > 0 || law_.limits.given();
  hinge_.inertia = axis.dot(law_.inertia * axis) + law_.mass * out.squaredNorm();
  hinge_.mass = hinge_.length = 1;
  hinge_.gravity = std::hypot(down, aside);  // [N m] restoring torque at 90 degrees; mass and length of the law are 1
  hinge_.damping = law_.angular_damping + law_.damping * out.squaredNorm();
  hinge_rest_ = hinge_.gravity > 0 ? std::atan2(aside, down) : 0;
}

void RigidBody::setHingeVelocities() noexcept {
  const Vector3d rate = hinge_rate_ * axis_world_;
  v_ = rate.cross(x_ - pivot_world_);
  l_ = turn_.quaternion() * principal_.cwiseProduct(turn_.quaternion().conjugate() * rate);
}

Quaterniond RigidBody::orientation() const noexcept {
  return (turn_.quaternion() * from_axes_.conjugate()).normalized();
}

Vector3d RigidBody::position() const noexcept {
  return x_ - orientation() * law_.center;
}

Vector3d RigidBody::angular() const noexcept {
  const Quaterniond& q = turn_.quaternion();
  return q * (q.conjugate() * l_).cwiseQuotient(principal_);
}

Vector3d RigidBody::linear() const noexcept {
  return v_ - angular().cross(orientation() * law_.center);
}

Vector3d RigidBody::bodyRate() const noexcept {
  return from_axes_ * (turn_.quaternion().conjugate() * l_).cwiseQuotient(principal_);
}

double RigidBody::energy() const noexcept {
  const double turned = law_.joint == Joint::kHinge ? hinge_angle_ - law_.rest : 0;
  return 0.5 * law_.mass * v_.squaredNorm() + 0.5 * l_.dot(angular()) +
         0.5 * law_.tether * (x_ - anchor_).squaredNorm() + 0.5 * law_.angular_tether * turned * turned -
         law_.mass * gravity_.dot(x_ - start_);
}

double RigidBody::jointPosition() const noexcept {
  if (law_.joint == Joint::kFree) return 0;
  return law_.joint == Joint::kHinge ? hinge_angle_ : axis_world_.dot(x_ - start_);
}

Stop RigidBody::stop() const noexcept {
  return stopAt(law_.limits, jointPosition());
}

double RigidBody::swingRate() const noexcept {
  const double weight_square = law_.joint == Joint::kHinge ? hinge_.frequencySquared() : 0;
  return weight_square > 0 ? std::sqrt(weight_square + law_.angular_tether / hinge_.inertia) : 0;
}

void RigidBody::setVelocity(const Vector3d& center_velocity, const Vector3d& body_rate) noexcept {
  const Vector3d rate = turn_.quaternion() * (from_axes_.conjugate() * body_rate);
  hinge_rate_ = law_.joint == Joint::kHinge ? axis_world_.dot(rate) : 0;
  v_ = center_velocity;
  l_.setZero();
  if (law_.joint == Joint::kHinge) {
    holdInRange(law_.limits, hinge_angle_, hinge_rate_);
    return setHingeVelocities();
  }
  if (law_.joint == Joint::kSlider) {
    v_ = axis_world_ * axis_world_.dot(center_velocity);
    return stopSlider();
  }
  l_ = turn_.quaternion() * principal_.cwiseProduct(from_axes_.conjugate() * body_rate);
}

}  // namespace hapticd::dynamics
