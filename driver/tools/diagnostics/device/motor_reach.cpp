// SPDX-License-Identifier: MIT
#include "diagnostics/device/motor_reach.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hapticd::diagnostics {
namespace {

constexpr double kSlack = 1e-9;  ///< relative tolerance, because a corner lies on its own bounds

bool within(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque, const Eigen::Vector3d& x) {
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i)
    if (std::abs(jacobian.col(i).dot(x)) > torque[static_cast<size_t>(i)] * (1 + kSlack)) return false;
  return true;
}

/// Returns the farthest of the eight corners at which three motors give their full torque and no other motor needs more
/// than it has.
double farthestCorner(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque, const Eigen::Vector3i& of) {
  constexpr double kParallel = 1e-14;  // volume of the three columns, relative to their lengths
  const Eigen::Vector3d a = jacobian.col(of[0]), b = jacobian.col(of[1]), c = jacobian.col(of[2]);
  const Eigen::Vector3d across[] = {b.cross(c), c.cross(a), a.cross(b)};
  const double volume = a.dot(across[0]);
  if (!(std::abs(volume) > kParallel * a.norm() * b.norm() * c.norm())) return 0;
  double most = 0;
  for (int signs = 0; signs < 8; ++signs) {
    Eigen::Vector3d x(0, 0, 0);  // by Cramer's rule
    for (int i = 0; i < 3; ++i) {
      const double all = torque[static_cast<size_t>(of[i])] * ((signs >> i & 1) != 0 ? 1 : -1);
      x += all / volume * across[i];
    }
    if (x.norm() > most && within(jacobian, torque, x)) most = x.norm();
  }
  return most;
}

}  // namespace

std::optional<double> farthestReach(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque) {
  // Share of the largest singular value. If a direction has less, the joints hardly move the tip along it, so the
  // motors bound no force there.
  constexpr double kFlat = 1e-2;
  const auto joints = static_cast<int>(jacobian.cols());
  if (joints < 3 || torque.size() != static_cast<size_t>(joints) || !jacobian.allFinite()) return std::nullopt;
  // The eigenvalues of J J^T, in ascending order, are the squares of the singular values of J.
  const Eigen::Matrix3d square = jacobian.lazyProduct(jacobian.transpose());
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
