// SPDX-License-Identifier: MIT
#include "kinematics/statics.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::kinematics {
namespace {

using Tall = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxJoints, 6>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kMaxSweeps = 30;  ///< bound; one-sided Jacobi needs 5 to 8 sweeps for any 6 columns

/// The singular value decomposition A = U diag(s) V^T by one-sided Jacobi rotations. Small singular values keep their
/// relative accuracy, which an eigenvalue decomposition of J J^T would lose. It allocates nothing.
struct Svd {
  Tall US;  ///< U diag(s): the columns are u_i s_i
  Matrix6d V = Matrix6d::Identity();
  Eigen::Matrix<double, 6, 1> s;

  explicit Svd(const Tall& A) noexcept : US(A) {
    for (int sweep = 0; sweep < kMaxSweeps && rotateAll(); ++sweep) {
    }
    for (int i = 0; i < 6; ++i) s[i] = US.col(i).norm();
  }

 private:
  bool rotateAll() noexcept {
    bool changed = false;
    for (int i = 0; i < 5; ++i)
      for (int j = i + 1; j < 6; ++j) changed |= rotate(i, j);
    return changed;
  }
  bool rotate(int i, int j) noexcept {
    const double a = US.col(i).squaredNorm(), b = US.col(j).squaredNorm(), c = US.col(i).dot(US.col(j));
    if (!(std::abs(c) > 1e-16 * std::sqrt(a * b)) || c == 0) return false;
    const double zeta = (b - a) / (2 * c);
    const double t = std::copysign(1 / (std::abs(zeta) + std::hypot(1.0, zeta)), zeta);
    const double cosine = 1 / std::hypot(1.0, t), sine = cosine * t;
    const JointVector left = US.col(i);
    US.col(i) = cosine * left - sine * US.col(j);
    US.col(j) = sine * left + cosine * US.col(j);
    const Eigen::Matrix<double, 6, 1> v = V.col(i);
    V.col(i) = cosine * v - sine * V.col(j);
    V.col(j) = sine * v + cosine * V.col(j);
    return true;
  }
};

/// Returns J^T with its angular columns multiplied by `length`, so that all six columns have the same unit.
Tall scaledTranspose(const Jacobian& J, double length) noexcept {
  Tall A = J.transpose();
  A.rightCols<3>() *= length;
  return A;
}

}  // namespace

JointVector jointTorques(const Jacobian& J, const Wrench& W) noexcept {
  JointVector tau(J.cols());
  for (Eigen::Index i = 0; i < J.cols(); ++i) tau[i] = J.col(i).dot(W);
  return tau;
}

WrenchEstimate wrenchFromTorques(const Jacobian& J, const JointVector& tau, const PseudoInverseOptions& how) noexcept {
  WrenchEstimate estimate;
  const Svd svd(scaledTranspose(J, how.length));
  const double largest = svd.s.maxCoeff(), floor = how.damping * largest;
  Wrench scaled = Wrench::Zero();
  for (int i = 0; i < 6; ++i) {
    const double s = svd.s[i];
    if (!(s > how.rank_tolerance * largest) || s == 0) continue;
    ++estimate.rank;
    const double lambda2 = s < floor ? (1 - (s / floor) * (s / floor)) * floor * floor : 0;
    scaled += svd.V.col(i) * (svd.US.col(i).dot(tau) / (s * s + lambda2));
  }
  estimate.W = scaled;
  estimate.W.tail<3>() *= how.length;
  estimate.residual = (jointTorques(J, estimate.W) - tau).norm();
  return estimate;
}

Conditioning conditioning(const Jacobian& J, double length, bool position_only) noexcept {
  Conditioning result;
  Svd svd(scaledTranspose(J, position_only ? 0.0 : length));
  std::sort(svd.s.data(), svd.s.data() + 6, [](double a, double b) { return a > b; });
  result.values = svd.s;
  const int possible = static_cast<int>(std::min<Eigen::Index>(position_only ? 3 : 6, J.cols()));
  if (possible == 0 || !(svd.s[0] > 0)) return result;
  result.manipulability = 1;
  for (int i = 0; i < possible; ++i) {
    result.manipulability *= svd.s[i];
    if (svd.s[i] > 1e-9 * svd.s[0]) ++result.rank;
  }
  result.smallest = svd.s[possible - 1];
  result.inverse_condition = result.smallest / svd.s[0];
  return result;
}

}  // namespace hapticd::kinematics
