// SPDX-License-Identifier: MIT
#include "kernels/contact/half_spaces.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace hapticd::contact {
namespace {

/// [m] a point that is so little outside of a half-space counts as on its plane
constexpr double kOnPlane = 1e-12;

/// Solves a . x = b for N planes that are not nearly parallel; returns whether there is a solution >= 0.
template <int N>
bool solvePushes(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b,
                 Eigen::Matrix<double, N, 1>& pushes) noexcept {
  constexpr double kParallel = 1e-12;  // determinant: sin^2 of the angle between two planes
  Eigen::Matrix<double, N, N> inverse;
  bool invertible = false;
  a.computeInverseWithCheck(inverse, invertible, kParallel);
  if (!invertible) return false;
  pushes = inverse * b;
  return (pushes.array() >= 0).all();
}

}  // namespace

void HalfSpaces::add(const HalfSpace& half_space) noexcept {
  count_ = std::min(count_ + 1, kMost);
  std::copy_backward(planes_.begin(), planes_.begin() + count_ - 1, planes_.begin() + count_);
  planes_[0] = half_space;
}

void HalfSpaces::age() noexcept {
  for (HalfSpace& plane : planes_) plane.old = true;
}

bool HalfSpaces::dropOld(const Eigen::Vector3d& center, double radius, double touching) noexcept {
  const auto gone = [&](const HalfSpace& plane) {
    return plane.old && (center - plane.foot.point).norm() > radius + touching;
  };
  const auto end = planes_.begin() + count_, kept = std::remove_if(planes_.begin(), end, gone);
  count_ = static_cast<int>(kept - planes_.begin());
  return kept != end;
}

void HalfSpaces::turnTo(const Eigen::Vector3d& center, double radius) noexcept {
  if (count_ == 1) return clear();
  for (int i = 0; i < count_; ++i) {
    HalfSpace& plane = planes_[static_cast<std::size_t>(i)];
    const Eigen::Vector3d out = center - plane.foot.point;
    if (!(out.squaredNorm() > 0)) continue;
    plane.normal = out.normalized();
    plane.offset = plane.normal.dot(plane.foot.point) + radius;
  }
}

bool HalfSpaces::holds(const Eigen::Vector3d& x) const noexcept {
  return std::all_of(planes_.begin(), planes_.begin() + count_,
                     [&x](const HalfSpace& plane) { return plane.height(x) >= -kOnPlane; });
}

/// Returns whether pushes of these planes alone carry p to a point x that no other plane forbids.
bool HalfSpaces::solve(const Subset& held, const Eigen::Vector3d& p, Eigen::Vector3d& x) const noexcept {
  const auto carried = [&]<int N>(std::integral_constant<int, N>) {
    Eigen::Matrix<double, N, 3> normals;
    Eigen::Matrix<double, N, 1> missing, pushes;
    for (int i = 0; i < N; ++i) {
      const HalfSpace& plane = planes_[static_cast<std::size_t>(held.planes[static_cast<std::size_t>(i)])];
      normals.row(i) = plane.normal;
      missing[i] = -plane.height(p);
    }
    if (!solvePushes<N>(normals * normals.transpose(), missing, pushes)) return false;
    x = p + normals.transpose() * pushes;
    return true;
  };
  const bool pushed = held.size == 1   ? carried(std::integral_constant<int, 1>())
                      : held.size == 2 ? carried(std::integral_constant<int, 2>())
                                       : carried(std::integral_constant<int, 3>());
  return pushed && holds(x);
}

void HalfSpaces::keep(const Subset& held) noexcept {
  for (int i = 0; i < held.size; ++i) {  // planes are listed in rising order, so none is overwritten before it is read
    const auto at = static_cast<std::size_t>(i);
    planes_[at] = planes_[static_cast<std::size_t>(held.planes[at])];
  }
  count_ = held.size;
}

Eigen::Vector3d HalfSpaces::nearestTo(const Eigen::Vector3d& p) noexcept {
  if (holds(p)) {
    clear();
    return p;
  }
  // all that can hold a point, the newest planes first; so the last plane of each shows whether there are so many
  static constexpr Subset kSubsets[] = {{{0}, 1},       {{1}, 1},       {{2}, 1},       {{3}, 1},      {{0, 1}, 2},
                                        {{0, 2}, 2},    {{0, 3}, 2},    {{1, 2}, 2},    {{1, 3}, 2},   {{2, 3}, 2},
                                        {{0, 1, 2}, 3}, {{0, 1, 3}, 3}, {{0, 2, 3}, 3}, {{1, 2, 3}, 3}};
  Eigen::Vector3d x;
  for (const Subset& held : kSubsets) {
    const int last = held.planes[static_cast<std::size_t>(held.size) - 1];
    if (last >= count_ || !solve(held, p, x)) continue;
    keep(held);
    return x;
  }
  keep({{0}, 1});
  return p - std::min(planes_[0].height(p), 0.0) * planes_[0].normal;
}

}  // namespace hapticd::contact
