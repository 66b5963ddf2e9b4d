// SPDX-License-Identifier: MIT
#include "servo/arm/tip_force.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hapticd::servo {

TipInverse::TipInverse(const TipJacobian& J) noexcept : J_(J), inverse_(Eigen::Matrix3d::Zero()) {
  // lazyProduct(): the code for large matrices is not instantiated; the bits are the same for so few joints
  const Eigen::Matrix3d JJt = J.lazyProduct(J.transpose());
  if (!JJt.allFinite()) {
    health_ = 0;
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(JJt);
  const double floor = kDamped * std::sqrt(std::max(0.0, of.eigenvalues().maxCoeff()));
  for (int i = 0; i < 3; ++i) {
    const double s2 = std::max(0.0, of.eigenvalues()[i]), s = std::sqrt(s2);
    if (!(s > 1e-9 * floor)) {
      health_ = 0;
      continue;
    }
    const double part = std::min(1.0, s / floor);
    const double lambda2 = (1 - part * part) * floor * floor;
    health_ = std::min(health_, part);
    inverse_ += of.eigenvectors().col(i) * of.eigenvectors().col(i).transpose() / (s2 + lambda2);
  }
}

JointVector TipInverse::rates(const Eigen::Vector3d& velocity) const noexcept {
  return J_.transpose() * (inverse_ * velocity);
}

Eigen::Vector3d TipInverse::force(const JointVector& torque) const noexcept {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < J_.cols(); ++i) sum += torque[i] * J_.col(i);
  return inverse_ * sum;
}

}  // namespace hapticd::servo
