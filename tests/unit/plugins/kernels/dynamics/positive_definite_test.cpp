// SPDX-License-Identifier: MIT
#include "kernels/dynamics/positive_definite.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace hapticd::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

TEST(SolvePositiveDefinite, SolvesSystemsOfMassesThatDifferByMillions) {
  Vector6d masses;
  masses << 1e3, 1e3, 1e3, 1e-3, 2e-3, 3e-3;
  for (int trial = 1; trial <= 100; ++trial) {
    const Matrix6d spread = Matrix6d::NullaryExpr([&](auto row, auto column) {
      return std::sin(static_cast<double>(trial * (1 + row) + 7 * column));  // any matrix
    });
    const Matrix6d A = masses.asDiagonal().toDenseMatrix() + 1e-3 * spread * spread.transpose();
    const Vector6d x = Vector6d::LinSpaced(-1, 2);
    EXPECT_LT((solvePositiveDefinite<6>(A, A * x) - x).norm(), 1e-9) << trial;
  }
}

TEST(SolvePositiveDefinite, ReadsTheLowerTriangleAlone) {
  Matrix3d A{{4, 99, 99}, {2, 5, 99}, {1, 3, 6}};
  const Matrix3d whole = A.selfadjointView<Eigen::Lower>();
  const Vector3d x(1, -2, 3);
  EXPECT_LT((solvePositiveDefinite<3>(A, whole * x) - x).norm(), 1e-14);
}

TEST(SolvePositiveDefinite, GivesNoNumbersForAnIndefiniteMatrix) {
  const Matrix3d A{{1, 2, 0}, {2, 1, 0}, {0, 0, 1}};
  EXPECT_FALSE((solvePositiveDefinite<3>(A, Vector3d::Ones()).allFinite()));
}

}  // namespace
}  // namespace hapticd::dynamics
