// SPDX-License-Identifier: MIT
/// A rigid body with its full inertia, free or joined to the world by a hinge or a slider.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <span>

#include "kernels/dynamics/contact_prediction.hpp"
#include "kernels/dynamics/joint_limits.hpp"
#include "kernels/dynamics/pendulum.hpp"
#include "kernels/dynamics/rotation.hpp"
#include "kernels/dynamics/top.hpp"
#include "kernels/dynamics/torsion_spring.hpp"

namespace hapticd::dynamics {

template <int N>
struct Balance;
struct FreeMotion;
struct JointMotion;

enum class Joint {
  kFree,
  kHinge,  ///< turns about an axis through a pivot
  kSlider  ///< moves along an axis but does not turn
};

/// The properties of a body. Centre, inertia, pivot and axis are in the model frame.
struct RigidBodyLaw {
  double mass = 1;                                               ///< [kg]
  Eigen::Vector3d center{0, 0, 0};                               ///< centre of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity() * 1e-3;  ///< inertia about the centre of mass [kg m^2]
  double damping = 0;                                            ///< [N s/m] drag against translation
  double angular_damping = 0;                                    ///< [N m s/rad] drag against rotation
  /// [N/m] spring from the centre of mass to its initial position; with a slider, to `rest`
  double tether = 0;
  double angular_tether = 0;  ///< [N m/rad] torsion spring that turns a hinge to `rest`
  Joint joint = Joint::kFree;
  Eigen::Vector3d pivot{0, 0, 0};  ///< pivot of a hinge [m]
  Eigen::Vector3d axis{0, 1, 0};   ///< direction of the axis of a hinge or slider
  /// angle [rad] of a hinge or travel [m] of a slider, from the initial pose, at which its spring is relaxed
  double rest = 0;
  JointLimits limits;  ///< end stops of a hinge or slider
};

/// The motion of a body. The translation is exact if the force is constant in the step (a parabola, a decay, or the
/// oscillator's exponential). For the rotation, the angular momentum is stored in the world frame, so integration
/// errors cannot change it. The body is turned by a splitting of fourth order, whose energy error stays bounded
/// (top.hpp). Torque and angular drag act before and after this turn, to second order (tests FreeTop.*,
/// RigidBody.DampedTopConvergesWithSecondOrder). A hinge is a pendulum (pendulum.hpp), and may have a
/// torsion spring (torsion_spring.hpp). At an end stop a hinge or slider loses the rate with which it arrives
/// (joint_limits.hpp). The energy of a step is never more than before it plus the work of the given force (tests
/// EndStop.*).
class RigidBody {
 public:
  /// [main] Places a body at rest.
  /// @param position, orientation of the model frame in the world
  /// @param gravity acceleration of gravity in the world frame [m/s^2]
  /// @throws std::invalid_argument if the mass or inertia is impossible, or if the axis has no length.
  RigidBody(const RigidBodyLaw& law, const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
            const Eigen::Vector3d& gravity);

  /// [rt] Advances by one step of dt [s] under a force [N] and a torque about the centre of mass [N m]. Both are in the
  /// world frame and constant in the step. NaN counts as zero.
  void step(const Eigen::Vector3d& force, const Eigen::Vector3d& torque, double dt) noexcept;

  /// [rt] Advances by one step of dt [s] under contacts, by backward Euler, which uses the forces at the end of the
  /// step. The motion stays bounded for every mass and stiffness. The cost is an additional damping ratio of w dt/2,
  /// with w^2 = k/m. If the forces were held constant in the step, a contact would need a damping B > k dt/2 and a mass
  /// above B dt/2 (test Coupling.HeldForcesAreStableOnlyAboveTheirBounds).
  void step(std::span<const PredictedContact> presses, double dt) noexcept;

  /// [rt] Returns the velocity [m/s] of the point of the body that is at `point` [m], in the world frame.
  Eigen::Vector3d velocityAt(const Eigen::Vector3d& point) const noexcept;

  Eigen::Vector3d position() const noexcept;        ///< [rt] position of the model frame, in the world [m]
  Eigen::Quaterniond orientation() const noexcept;  ///< [rt] orientation of the model frame, in the world
  /// [rt] velocity of the model frame's origin, in the world [m/s]
  Eigen::Vector3d linear() const noexcept;
  Eigen::Vector3d angular() const noexcept;                      ///< [rt] angular velocity, in the world [rad/s]
  const Eigen::Vector3d& center() const noexcept { return x_; }  ///< [rt] centre of mass, in the world [m]
  /// [rt] angular momentum about the centre of mass, in the world [kg m^2/s]
  const Eigen::Vector3d& momentum() const noexcept { return l_; }
  Eigen::Vector3d bodyRate() const noexcept;  ///< [rt] angular velocity in the model frame [rad/s]
  /// [rt] energy [J]: kinetic energy, energy of the springs, and potential energy of gravity (0 at the start)
  double energy() const noexcept;
  /// [rt] angle [rad] of a hinge or travel [m] of a slider since the initial pose; 0 for a free body. The angle counts
  /// whole turns if there is a torsion spring or a limit.
  double jointPosition() const noexcept;
  /// [any] moment of inertia about the axis of a hinge [kg m^2], or mass of a slider [kg]; 0 for a free body
  double jointInertia() const noexcept {
    return law_.joint == Joint::kFree ? 0 : law_.joint == Joint::kHinge ? hinge_.inertia : law_.mass;
  }
  Stop stop() const noexcept;  ///< [rt] end stop at which the joint stands
  /// [any] Returns the angular frequency [rad/s] of small swings of a hinge about its lowest point; 0 for other joints.
  /// Steps in which such a swing advances by more than kLargestSwing [rad] are not stable (pendulum.hpp).
  /// A hinge with a torsion spring and no weight is stepped exactly, so it has no such bound.
  double swingRate() const noexcept;

  /// [rt] Sets the velocity of the centre of mass (world frame, m/s) and the angular velocity (model frame, rad/s).
  /// Parts that the joint does not allow are dropped.
  void setVelocity(const Eigen::Vector3d& center_velocity, const Eigen::Vector3d& body_rate) noexcept;

 private:
  void translate(const Eigen::Vector3d& force, double dt) noexcept;
  void rotate(const Eigen::Vector3d& torque, double dt) noexcept;
  void decay(double time) noexcept;
  void initializeHinge() noexcept;
  void setHingeVelocities() noexcept;
  void stopSlider() noexcept;
  void poseHinge(double angle) noexcept;
  void spin(double dt) noexcept;
  void stepHinge(const Eigen::Vector3d& force, const Eigen::Vector3d& torque, double dt) noexcept;
  using Vector1d = Eigen::Matrix<double, 1, 1>;
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  Eigen::Vector3d ownForce(double dt) const noexcept;
  Balance<6> own(const FreeMotion& motion, double dt) const noexcept;
  Balance<1> own(const JointMotion& joint, double dt) const noexcept;
  template <class Motion>
  void stepUnder(std::span<const PredictedContact> presses, const Motion& motion, double dt) noexcept;
  void drift(const Vector6d& change, double dt) noexcept;
  void drift(const Vector1d& change, double dt) noexcept;

  RigidBodyLaw law_;
  Eigen::Vector3d gravity_, start_, pivot_world_, axis_world_;
  Eigen::Vector3d anchor_;        // [m] where the tether ends, in the world
  Eigen::Vector3d principal_;     // principal moments of inertia [kg m^2]
  Eigen::Quaterniond from_axes_;  // rotation from the principal axes to the model frame
  Top top_;
  Rotation turn_;  // rotation from the principal axes to the world
  Eigen::Vector3d x_{0, 0, 0}, v_{0, 0, 0}, l_{0, 0, 0};
  PendulumLaw hinge_;          ///< the hinge as a pendulum; its lowest point is at the angle hinge_rest_
  bool counts_turns_ = false;  ///< true if a spring or a stop depends on whole turns of the hinge
  double hinge_angle_ = 0, hinge_rate_ = 0, hinge_rest_ = 0;  // angles from the initial pose [rad] and rate [rad/s]
  Eigen::Quaterniond start_turn_{1, 0, 0, 0};
};

}  // namespace hapticd::dynamics
