// SPDX-License-Identifier: MIT
#include "kernels/dynamics/mass_properties.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace hapticd::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

MassProperties boxProperties(const Eigen::AlignedBox3d& box) noexcept {
  const Vector3d squares = box.sizes().cwiseAbs2();
  const Vector3d moments = (Vector3d::Constant(squares.sum()) - squares) / 12;
  return {box.center(), moments.asDiagonal()};
}

/// Integrates by div(x e_x) = 1, div(x^2/2 e_x) = x, div(x^3/3 e_x) = x^2, div(x^2 y/2 e_x + x y^2/2 e_y)/2 = x y.
void SolidIntegral::add(const Vector3d& point, const Vector3d& area) noexcept {
  const Vector3d r = point - origin_;
  volume_ += r.dot(area) / 3;
  first_ += r.cwiseAbs2().cwiseProduct(area) / 2;
  for (int i = 0; i < 3; ++i) {
    second_(i, i) += r[i] * r[i] * r[i] * area[i] / 3;
    const int j = (i + 1) % 3;
    second_(i, j) += r[i] * r[j] * (r[i] * area[i] + r[j] * area[j]) / 4;
  }
}

MassProperties SolidIntegral::properties() const noexcept {
  MassProperties all;
  const Vector3d center = first_ / volume_;
  Matrix3d spread = second_;
  for (int i = 0; i < 3; ++i) spread((i + 1) % 3, i) = spread(i, (i + 1) % 3);
  spread = (spread / volume_ - center * center.transpose()).eval();
  all.center = origin_ + center;
  all.inertia = spread.trace() * Matrix3d::Identity() - spread;
  return all;
}

MassProperties SolidIntegral::propertiesIn(const Eigen::AlignedBox3d& box, bool& bounded) const noexcept {
  constexpr double kEmptiest = 1e-6;  // share of the box; a smaller volume may be only rounding
  bounded = bounded && std::abs(volume_) > kEmptiest * box.volume();
  if (bounded) return properties();
  Eigen::AlignedBox3d thick = box;  // a flat model must have moments of inertia too
  const Vector3d margin = Vector3d::Constant(1e-3 * box.diagonal().norm());
  thick.min() -= margin;
  thick.max() += margin;
  return boxProperties(thick);
}

namespace {

[[noreturn]] void refuse(const Vector3d& moments, const char* expected) {
  char text[160];
  std::snprintf(text, sizeof text, "inertia: principal moments %.6g, %.6g, %.6g kg m^2, expected %s", moments[0],
                moments[1], moments[2], expected);
  throw std::invalid_argument(text);
}

}  // namespace

Vector3d principalMoments(const Matrix3d& inertia) {
  const double size = inertia.cwiseAbs().maxCoeff();
  if (!inertia.allFinite() || !((inertia - inertia.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * size))
    throw std::invalid_argument("inertia: expected a symmetric matrix of finite numbers");
  const Vector3d moments = Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(moments[0] > 0)) refuse(moments, "all above 0");
  return moments;
}

void validateSolid(const Matrix3d& inertia) {
  const Vector3d moments = principalMoments(inertia);
  constexpr double kRounded = 1e-6;  // tolerance for the rounded numbers of a data sheet
  if (moments[2] > (moments[0] + moments[1]) * (1 + kRounded))
    refuse(moments, "no moment above the sum of the other two");
}

}  // namespace hapticd::dynamics
