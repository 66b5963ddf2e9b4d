// SPDX-License-Identifier: MIT
/// A rigid body with its full inertia, free or on a joint to the world.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <span>

#include "kernels/dynamics/pendulum.hpp"
#include "kernels/dynamics/press.hpp"
#include "kernels/dynamics/rotation.hpp"
#include "kernels/dynamics/top.hpp"

namespace hapticd::dynamics {

enum class Joint {
  kFree,
  kHinge,  ///< turns about an axis through a pivot
  kSlider  ///< moves along an axis but does not turn
};

/// The properties of a body. Centre, inertia, pivot and axis are in the model's frame.
struct RigidBodyLaw {
  double mass = 1;                                               ///< [kg]
  Eigen::Vector3d center{0, 0, 0};                               ///< of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity() * 1e-3;  ///< about the centre [kg m^2]
  double damping = 0;                                            ///< [N s/m] drag against translation
  double angular_damping = 0;                                    ///< [N m s/rad]
  double tether = 0;                                             ///< [N/m] spring from the centre to where it started
  Joint joint = Joint::kFree;
  Eigen::Vector3d pivot{0, 0, 0};  ///< hinge [m]
  Eigen::Vector3d axis{0, 1, 0};   ///< hinge, slider
};

/// Translation is exact under a force that is constant in the step (parabola, decay, or the oscillator's exponential).
/// Rotation keeps the angular momentum in the world, which no integrator then can change, and turns the body by a
/// splitting of fourth order whose energy error stays bounded (top.hpp); torque and angular drag act around it, of
/// second order (tests FreeTop.*, RigidBody.DampedTopConvergesWithSecondOrder). A hinge is a pendulum (pendulum.hpp).
class RigidBody {
 public:
  /// [main] @param position, orientation of the model's frame in the world  @param gravity world [m/s^2]
  /// @throws std::invalid_argument: mass or inertia no body has, axis of no length.
  RigidBody(const RigidBodyLaw& law, const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
            const Eigen::Vector3d& gravity);

  /// [rt] One step of dt [s] under a force [N] and a torque about the centre of mass [N m], world frame, both constant
  /// in the step. NaN counts as zero.
  void step(const Eigen::Vector3d& force, const Eigen::Vector3d& torque, double dt) noexcept;

  /// [rt] One step of dt [s] under contacts, by backward Euler: all forces are those of its end. Bounded for every mass
  /// and stiffness, at the price of w dt/2 of critical damping, w^2 = k/m. Held forces would need damping B > k dt/2
  /// and a mass above B dt/2 (test Coupling.HeldForcesAreStableOnlyAboveTheirBounds).
  void step(std::span<const Press> presses, double dt) noexcept;

  /// [rt] Velocity [m/s] of the point of the body that is at `point` [m], world.
  Eigen::Vector3d velocityAt(const Eigen::Vector3d& point) const noexcept;

  Eigen::Vector3d position() const noexcept;                       ///< [rt] of the model's frame, world [m]
  Eigen::Quaterniond orientation() const noexcept;                 ///< [rt]
  Eigen::Vector3d linear() const noexcept;                         ///< [rt] velocity of the frame's origin, world [m/s]
  Eigen::Vector3d angular() const noexcept;                        ///< [rt] world [rad/s]
  const Eigen::Vector3d& center() const noexcept { return x_; }    ///< [rt] of mass, world [m]
  const Eigen::Vector3d& momentum() const noexcept { return l_; }  ///< [rt] angular, about the centre, world
  Eigen::Vector3d bodyRate() const noexcept;  ///< [rt] angular velocity in the model's frame [rad/s]
  double energy() const noexcept;             ///< [rt] kinetic, tether, and gravity from the start [J]
  /// [any] How fast a hinge swings about its lowest point [rad/s], 0 for other joints: a step of more than
  /// kLargestSwing rad of it is not stable (pendulum.hpp).
  double swingRate() const noexcept { return std::sqrt(law_.joint == Joint::kHinge ? hinge_.frequencySquared() : 0); }

  /// [rt] Velocity of the centre (world) and angular velocity (model's frame); a joint keeps only what it allows.
  void setVelocity(const Eigen::Vector3d& center_velocity, const Eigen::Vector3d& body_rate) noexcept;

 private:
  void translate(const Eigen::Vector3d& force, double dt) noexcept;
  void rotate(const Eigen::Vector3d& torque, double dt) noexcept;
  void decay(double time) noexcept;
  void hang() noexcept;
  void setHingeVelocities() noexcept;
  void poseHinge(double angle) noexcept;
  void spin(double dt) noexcept;
  void swing(const Eigen::Vector3d& force, const Eigen::Vector3d& torque, double dt) noexcept;
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  Vector6d changeUnder(const Matrix6d& resisting, const Vector6d& impulse) const noexcept;
  Matrix6d ownResistance(double dt) const noexcept;
  Vector6d ownImpulse(double dt) const noexcept;
  void drift(const Vector6d& change, double dt) noexcept;

  RigidBodyLaw law_;
  Eigen::Vector3d gravity_, start_, pivot_world_, axis_world_;
  Eigen::Vector3d principal_;     // moments of inertia
  Eigen::Quaterniond from_axes_;  // principal axes to the model's frame
  Top top_;
  Rotation turn_;  // principal axes to the world
  Eigen::Vector3d x_{0, 0, 0}, v_{0, 0, 0}, l_{0, 0, 0};
  PendulumLaw hinge_;  ///< about the axis, from its lowest point, which is at hinge_rest_
  double hinge_angle_ = 0, hinge_rate_ = 0, hinge_rest_ = 0;  // from the start [rad]
  Eigen::Quaterniond start_turn_{1, 0, 0, 0};
};

}  // namespace hapticd::dynamics
