// SPDX-License-Identifier: MIT
/// The nearest point to a probe that some planes leave free.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hapticd::contact {

/// The points x with normal . x >= offset.
struct HalfSpace {
  Eigen::Vector3d normal{0, 0, 1};  ///< unit vector into the half-space
  double offset = 0;                ///< [m] distance of its plane from the origin, along the normal

  double height(const Eigen::Vector3d& x) const noexcept { return normal.dot(x) - offset; }  ///< [m] > 0 inside
};

inline constexpr std::size_t kMostHalfSpaces = 4;

/// Planes that hold a point back. In space three at most can do so.
struct Holders {
  std::array<std::uint8_t, 3> planes{};  ///< indices in rising order
  std::uint8_t size = 0;
};

/// A point, and the planes that hold it back from where it would go.
struct HeldPoint {
  Eigen::Vector3d point{0, 0, 0};  ///< [m]
  Holders by{};
};

/// [rt] Returns the point of the common part of the half-spaces that is nearest to p [m]. If they have no common point,
/// only the first counts; of planes that hold equally, the first. The nearest point is the one that is held by pushes
/// alone: p plus positive multiples of the normals (Karush, Kuhn and Tucker; Nocedal and Wright, Numerical
/// Optimization, 2nd ed., 16.1).
/// @param spaces kMostHalfSpaces at most
HeldPoint nearestCommonPoint(std::span<const HalfSpace> spaces, const Eigen::Vector3d& p) noexcept;

}  // namespace hapticd::contact
