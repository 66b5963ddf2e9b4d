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

bool isCommon(std::span<const HalfSpace> spaces, const Eigen::Vector3d& x) noexcept {
  return std::all_of(spaces.begin(), spaces.end(),
                     [&x](const HalfSpace& space) { return space.height(x) >= -kOnPlane; });
}

/// Returns whether pushes of these planes alone carry p to a point x that no other plane forbids.
bool solve(std::span<const HalfSpace> spaces, const Holders& held, const Eigen::Vector3d& p,
           Eigen::Vector3d& x) noexcept {
  const auto carried = [&]<std::size_t N>(std::integral_constant<std::size_t, N>) {
    Eigen::Matrix<double, N, 3> normals;
    Eigen::Matrix<double, N, 1> missing, pushes;
    for (std::size_t i = 0; i < N; ++i) {
      const HalfSpace& space = spaces[held.planes[i]];
      normals.row(static_cast<Eigen::Index>(i)) = space.normal;
      missing[static_cast<Eigen::Index>(i)] = -space.height(p);
    }
    if (!solvePushes<N>(normals * normals.transpose(), missing, pushes)) return false;
    x = p + normals.transpose() * pushes;
    return true;
  };
  const bool pushed = held.size == 1   ? carried(std::integral_constant<std::size_t, 1>())
                      : held.size == 2 ? carried(std::integral_constant<std::size_t, 2>())
                                       : carried(std::integral_constant<std::size_t, 3>());
  return pushed && isCommon(spaces, x);
}

}  // namespace

HeldPoint nearestCommonPoint(std::span<const HalfSpace> spaces, const Eigen::Vector3d& p) noexcept {
  if (isCommon(spaces, p)) return {p, {}};
  // all that can hold a point, the first planes first; so the last plane of each shows whether there are so many
  static constexpr Holders kHolders[] = {{{0}, 1},       {{1}, 1},       {{2}, 1},       {{3}, 1},      {{0, 1}, 2},
                                         {{0, 2}, 2},    {{0, 3}, 2},    {{1, 2}, 2},    {{1, 3}, 2},   {{2, 3}, 2},
                                         {{0, 1, 2}, 3}, {{0, 1, 3}, 3}, {{0, 2, 3}, 3}, {{1, 2, 3}, 3}};
  Eigen::Vector3d x;
  for (const Holders& held : kHolders)
    if (held.planes[held.size - 1] < spaces.size() && solve(spaces, held, p, x)) return {x, held};
  return {p - std::min(spaces[0].height(p), 0.0) * spaces[0].normal, kHolders[0]};
}

}  // namespace hapticd::contact
