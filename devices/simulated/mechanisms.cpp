// SPDX-License-Identifier: MIT
#include "simulated/mechanisms.hpp"

#include <Eigen/Geometry>

namespace hapticd::simulated {

using kinematics::ChainFrames;
using kinematics::ChainGeometry;
using kinematics::ChainLink;

void PhantomMechanism::evaluate(const Vector& q, const Vector& qd) noexcept {
  const kinematics::PhantomAngles at(q);  // computed once, because sines are a third of the work
  dynamics_.evaluate(at, qd, M, bias);
  tip = arm_.position(at);
  J = arm_.positionJacobian(at);
  bias += arm_.weight(at, gravity_);
  if (hand_mass_ <= 0) return;
  // `swing` is (dJ/dt) qd, the tip's acceleration when no joint accelerates.
  const double l1 = arm_.geometry().l1, l2 = arm_.geometry().l2;
  const auto [s1, c1, s2, c2, s3, c3] = at;
  const double r = l1 * c2 + l2 * s3, r_rate = -l1 * s2 * qd[1] + l2 * c3 * qd[2];
  const double w1 = qd[0] * qd[0], w2 = qd[1] * qd[1], w3 = qd[2] * qd[2];
  const double out = -l1 * c2 * w2 - l2 * s3 * w3 - r * w1, aside = 2 * r_rate * qd[0];
  const Eigen::Vector3d swing(out * s1 + aside * c1, -l1 * s2 * w2 + l2 * c3 * w3, out * c1 - aside * s1);
  M.noalias() += hand_mass_ * J.transpose() * J;
  bias.noalias() += hand_mass_ * J.transpose() * swing;
}

DeltaMechanism::DeltaMechanism(const kinematics::Delta& arm, const Vector& rotor, double hand_mass,
                               const Eigen::Vector3d& gravity)
    : arm_(arm), gravity_(gravity) {
  const kinematics::DeltaGeometry& g = arm.geometry();
  inertia_ = rotor.array() + (g.arm_mass / 3 + 0.5 * g.rod_mass) * g.a * g.a;
  mass_ = g.platform_mass + 1.5 * g.rod_mass + hand_mass;
}

void DeltaMechanism::evaluate(const Vector& q, const Vector& qd) noexcept {
  kinematics::DeltaMotion motion;
  kinematics::JointVector weight;
  meets_ = arm_.motion(q, qd, motion) && arm_.gravity(q, gravity_, weight);
  if (!meets_) return;
  last_ = q;
  tip = motion.tip;
  J = motion.J;
  M = mass_ * J.transpose() * J;
  M.diagonal() += inertia_;
  bias = mass_ * J.transpose() * motion.swing + weight;  // without the hand's mass, because the hand carries its weight
}

namespace {

/// Returns the chain with the hand's mass as a point mass at its tip.
ChainGeometry loaded(ChainGeometry geometry, double mass) {
  if (geometry.links.empty() || mass <= 0) return geometry;
  ChainLink& last = geometry.links.back();
  const Eigen::Vector3d center = (last.mass * last.center + mass * geometry.tool.position) / (last.mass + mass);
  const auto about = [&](const Eigen::Vector3d& at, double m) -> Eigen::Matrix3d {
    const Eigen::Vector3d d = at - center;
    return m * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  };
  last.inertia += about(last.center, last.mass) + about(geometry.tool.position, mass);
  last.center = center;
  last.mass += mass;
  return geometry;
}

}  // namespace

ChainMechanism::ChainMechanism(const ChainGeometry& geometry, const Vector& rotor, double hand_mass,
                               const Eigen::Vector3d& gravity)
    : arm_(geometry),
      loaded_(loaded(geometry, hand_mass)),
      rotor_(rotor),
      gravity_(gravity),
      tool_(geometry.tool.position) {}

void ChainMechanism::evaluate(const Vector& q, const Vector& qd) noexcept {
  ChainFrames at;
  arm_.frames(q, at);
  chainDynamics(loaded_, at, qd, M, bias);
  M.diagonal() += rotor_;
  Vector weight;
  arm_.gravity(q, gravity_, weight);  // without the hand's mass, because the hand carries its own weight
  bias += weight;
  const auto last = static_cast<size_t>(arm_.jointCount());
  tip = at.o[last] + at.R[last] * tool_;
  J = arm_.jacobianAt(at, tip, arm_.jointCount()).topRows<3>();
}

}  // namespace hapticd::simulated
