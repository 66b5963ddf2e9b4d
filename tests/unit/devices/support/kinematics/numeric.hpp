// SPDX-License-Identifier: MIT
/// Truths that share no code with the kinematics under test: numeric differentiation in long steps of high order.
#pragma once
#include <random>

#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

/// Rotation vector of b relative to a, in the frame of the parent.
inline Eigen::Vector3d turnFrom(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::AngleAxisd turn(b * a.conjugate());
  const double angle = turn.angle() > M_PI ? turn.angle() - 2 * M_PI : turn.angle();
  return angle * turn.axis();
}

/// d pose / d q by central differences of sixth order: error below 1e-11 for lengths of a metre.
inline Jacobian numericJacobian(const Arm& arm, const JointVector& q) {
  constexpr double kStep = 2e-3;
  constexpr double kWeights[] = {3.0 / 4, -3.0 / 20, 1.0 / 60};
  Jacobian J = Jacobian::Zero(6, arm.jointCount());
  for (int i = 0; i < arm.jointCount(); ++i)
    for (int n = 1; n <= 3; ++n) {
      JointVector ahead = q, behind = q;
      ahead[i] += n * kStep;
      behind[i] -= n * kStep;
      Pose a, b;
      EXPECT_TRUE(arm.forward(ahead, a) && arm.forward(behind, b));
      J.col(i).head<3>() += kWeights[n - 1] / kStep * (a.position - b.position);
      J.col(i).tail<3>() += kWeights[n - 1] / kStep * turnFrom(b.orientation, a.orientation);
    }
  return J;
}

/// Reproducible random joints within the limits, shrunk by `margin` [rad].
class RandomJoints {
 public:
  explicit RandomJoints(const Arm& arm, double margin = 0.05) : arm_(arm), margin_(margin) {}
  JointVector next() {
    for (;;) {
      JointVector q(arm_.jointCount());
      for (int i = 0; i < q.size(); ++i)
        q[i] = std::uniform_real_distribution<double>(arm_.limits().min[i] + margin_,
                                                      arm_.limits().max[i] - margin_)(random_);
      Pose pose;
      if (arm_.allowed(q) && arm_.forward(q, pose)) return q;
    }
  }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

 private:
  const Arm& arm_;
  double margin_;
  std::mt19937_64 random_{7};
};

}  // namespace hapticd::kinematics
