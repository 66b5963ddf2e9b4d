// SPDX-License-Identifier: MIT
/// The mechanisms of simulated arms: the PHANToM's parallelogram, the delta, and serial chains.
#pragma once
#include "kinematics/chain_dynamics.hpp"
#include "kinematics/delta.hpp"
#include "kinematics/phantom_dynamics.hpp"

namespace hapticd::simulated {

/// Calls add(direction, excess [rad] or [m]) for each joint that is beyond its limits.
template <class Vector, class Add>
void addLimits(const kinematics::JointLimits& limits, const Vector& q, const Add& add) noexcept {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (q[i] > limits.max[i]) add(Vector::Unit(q.size(), i), q[i] - limits.max[i]);
    if (q[i] < limits.min[i]) add(Vector::Unit(q.size(), i), q[i] - limits.min[i]);
  }
}

/// A PHANToM with the mass of a hand at its tip.
class PhantomMechanism {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  PhantomMechanism(const kinematics::Phantom& arm, const kinematics::PhantomInertia& inertia, double hand_mass,
                   const Eigen::Vector3d& gravity)
      : arm_(arm), dynamics_(arm.geometry(), inertia), hand_mass_(hand_mass), gravity_(gravity) {}

  void evaluate(const Vector& q, const Vector& qd) noexcept;

  template <class Add>
  void stops(const Vector& q, const Add& add) const noexcept {
    addLimits(arm_.limits(), q, add);
    const double opening = q[2] - q[1];
    const Vector both(0, -1, 1);
    if (opening > arm_.largestOpening()) add(both, opening - arm_.largestOpening());
    if (opening < -arm_.largestClosing()) add(both, opening + arm_.largestClosing());
  }

  Matrix M, J;
  Vector bias, tip;

 private:
  kinematics::Phantom arm_;
  kinematics::PhantomDynamics dynamics_;
  double hand_mass_;
  Eigen::Vector3d gravity_;
};

/// A delta with the mass of a hand at its tip. As in its gravity(), half of each rod pair's mass is at the end of its
/// upper arm, and the other half at the platform; an upper arm is a thin rod.
class DeltaMechanism {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  /// @param rotor inertia that each motor adds to its joint [kg m^2]
  DeltaMechanism(const kinematics::Delta& arm, const Vector& rotor, double hand_mass, const Eigen::Vector3d& gravity);

  /// Where the arm cannot be, its members stay those of the last place where it could.
  void evaluate(const Vector& q, const Vector& qd) noexcept;

  template <class Add>
  void stops(const Vector& q, const Add& add) const noexcept {
    addLimits(arm_.limits(), q, add);
    if (meets_) return;
    for (int i = 0; i < 3; ++i) add(Vector::Unit(i), q[i] - last_[i]);  // the rods hold the upper arms back
  }

  Matrix M = Matrix::Zero(), J = Matrix::Zero();
  Vector bias = Vector::Zero(), tip = Vector::Zero();

 private:
  kinematics::Delta arm_;
  Vector inertia_;  ///< [kg m^2] of each upper arm with its motor and half of its rods
  double mass_;     ///< [kg] at the tip
  Eigen::Vector3d gravity_;
  bool meets_ = true;             ///< the three arms meet in the platform
  Vector last_ = Vector::Zero();  ///< [rad] the last joint positions at which they did
};

/// A serial chain. The hand's mass is part of its last link.
class ChainMechanism {
 public:
  using Vector = kinematics::JointVector;
  using Matrix = kinematics::MassMatrix;

  /// @param rotor inertia that each motor adds to its joint [kg m^2]
  ChainMechanism(const kinematics::ChainGeometry& geometry, const Vector& rotor, double hand_mass,
                 const Eigen::Vector3d& gravity);

  void evaluate(const Vector& q, const Vector& qd) noexcept;

  template <class Add>
  void stops(const Vector& q, const Add& add) const noexcept {
    addLimits(arm_.limits(), q, add);
  }

  Matrix M;
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kinematics::kMaxJoints> J;
  Vector bias;
  Eigen::Vector3d tip;

 private:
  kinematics::Chain arm_, loaded_;  ///< the arm without the hand's mass, and with it
  Vector rotor_;
  Eigen::Vector3d gravity_, tool_;
};

}  // namespace hapticd::simulated
