// SPDX-License-Identifier: MIT
#include "joint_torque.hpp"

#include <Eigen/Dense>

namespace hapticd::hd {

namespace {

constexpr size_t kArm = 3, kAll = 6;  // number of joints without the gimbal, and with it

/// Returns the W that minimises |J^T W - torque|^2 + damping |W|^2.
template <int N>
Eigen::Matrix<double, N, 1> solved(const Eigen::Matrix<double, N, N>& J, const Eigen::Matrix<double, N, 1>& torque) {
  // Damping as a share of the mean square of a row; far from singular poses it causes only a small error.
  constexpr double kDamping = 1e-9;
  Eigen::Matrix<double, N, N> normal = J * J.transpose();
  const double size = normal.trace();
  if (!(size > 0)) return Eigen::Matrix<double, N, 1>::Zero();
  normal.diagonal().array() += kDamping * size;
  return normal.ldlt().solve(J * torque);
}

template <int N>
Eigen::Matrix<double, N, N> columnsOf(const DeviceFacts& facts, const hapticd_jacobian& jacobian) {
  Eigen::Matrix<double, N, N> J;
  for (int row = 0; row < N; ++row)
    for (int i = 0; i < N; ++i) {
      const DeviceFacts::Joint& joint = facts.joint_of[static_cast<size_t>(i)];
      J(row, i) = joint.sign * jacobian.rows[row][joint.joint];
    }
  return J;
}

}  // namespace

void wrenchOf(const DeviceFacts& facts, const hapticd_jacobian& jacobian, const double torque[6], double force[3],
              double moment[3]) {
  Eigen::Map<Eigen::Vector3d> f(force), m(moment);
  f.setZero(), m.setZero();
  const auto joints = facts.joint_of.size();
  if (joints >= kAll && facts.output_dof >= static_cast<int>(kAll)) {
    const auto wrench = solved<6>(columnsOf<6>(facts, jacobian), Eigen::Map<const Eigen::Matrix<double, 6, 1>>(torque));
    f = wrench.head<3>(), m = wrench.tail<3>();
  } else if (joints >= kArm) {
    f = solved<3>(columnsOf<3>(facts, jacobian), Eigen::Map<const Eigen::Vector3d>(torque));
  }
}

}  // namespace hapticd::hd
