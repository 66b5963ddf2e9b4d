// SPDX-License-Identifier: MIT
/// The dynamics of a delta arm for the simulated plant: upper arms with half of their rods, and a platform that only
/// translates with the other halves and the hand.
#pragma once
#include "kinematics/delta.hpp"
#include "simulated/plant.hpp"

namespace hapticd::emulator {

class DeltaMechanism {
 public:
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;

  DeltaMechanism(const kinematics::Delta& arm, const kinematics::DeltaGeometry& geometry, double hand_mass)
      : arm_(arm),
        platform_(geometry.platform_mass + 1.5 * geometry.rod_mass + hand_mass),
        upper_(geometry.a * geometry.a * (geometry.arm_mass / 3 + geometry.rod_mass / 2)) {}

  void evaluate(const Vector& q, const Vector& qd) noexcept {
    constexpr double kStep = 1e-5;  // s: the acceleration of the tip when no joint accelerates, by difference
    kinematics::Jacobian now, later;
    kinematics::Pose pose;
    if (!arm_.forward(q, pose) || !arm_.jacobian(q, now)) return;  // out of reach: keep the last
    const Vector ahead = q + kStep * qd;
    tip = pose.position;
    J = now.topRows<3>();
    M = platform_ * J.transpose() * J + upper_ * Matrix::Identity();
    bias.setZero();
    if (arm_.jacobian(ahead, later))
      bias = platform_ * J.transpose() * ((later.topRows<3>() - now.topRows<3>()) * qd / kStep);
    kinematics::JointVector weight(3);
    if (arm_.gravity(q, {0, -9.81, 0}, weight)) bias += weight;
  }

  template <class Add>
  void stops(const Vector& q, const Add& add) const noexcept {
    for (int i = 0; i < 3; ++i) {
      if (q[i] > arm_.limits().max[i]) add(Vector::Unit(i), q[i] - arm_.limits().max[i]);
      if (q[i] < arm_.limits().min[i]) add(Vector::Unit(i), q[i] - arm_.limits().min[i]);
    }
  }

  Matrix M = Matrix::Identity(), J = Matrix::Zero();
  Vector bias = Vector::Zero(), tip = Vector::Zero();

 private:
  kinematics::Delta arm_;
  double platform_, upper_;
};

}  // namespace hapticd::emulator
