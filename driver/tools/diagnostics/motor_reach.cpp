// SPDX-License-Identifier: MIT
#include "diagnostics/motor_reach.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace hapticd::diagnostics {
namespace {

constexpr double kSlack = 1e-9;  ///< relative: a corner lies on its own bounds

bool within(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque, const Eigen::Vector3d& x) {
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i)
    if (std::abs(jacobian.col(i).dot(x)) > torque[static_cast<size_t>(i)] * (1 + kSlack)) return false;
  return true;
}

/// The farthest of the eight corners at which three motors give all they have and no other has to give more.
double farthestCorner(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque, const Eigen::Vector3i& of) {
  Eigen::Matrix3d rows;
  for (int i = 0; i < 3; ++i) rows.row(i) = jacobian.col(of[i]).transpose();
  const Eigen::FullPivLU<Eigen::Matrix3d> solver(rows);
  if (!solver.isInvertible()) return 0;
  double most = 0;
  for (int signs = 0; signs < 8; ++signs) {
    Eigen::Vector3d all;
    for (int i = 0; i < 3; ++i) all[i] = torque[static_cast<size_t>(of[i])] * ((signs >> i & 1) != 0 ? 1 : -1);
    const Eigen::Vector3d x = solver.solve(all);
    if (x.norm() > most && within(jacobian, torque, x)) most = x.norm();
  }
  return most;
}

}  // namespace

std::optional<double> farthestReach(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque) {
  constexpr double kFlat = 1e-2;  // of the longest: a direction that the joints hardly move along is not bounded
  const auto joints = static_cast<int>(jacobian.cols());
  if (joints < 3 || torque.size() != static_cast<size_t>(joints) || !jacobian.allFinite()) return std::nullopt;
  // The eigenvalues of J J^T, in ascending order, are the squares of the singular values of J.
  const Eigen::Matrix3d square = jacobian * jacobian.transpose();
  const Eigen::Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(square, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(squares[0] > kFlat * kFlat * squares[2])) return std::nullopt;
  double most = 0;
  for (int a = 0; a < joints; ++a)
    for (int b = a + 1; b < joints; ++b)
      for (int c = b + 1; c < joints; ++c)
        most = std::max(most, farthestCorner(jacobian, torque, Eigen::Vector3i(a, b, c)));
  return most > 0 ? std::optional(most) : std::nullopt;
}

}  // namespace hapticd::diagnostics
