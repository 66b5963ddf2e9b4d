// SPDX-License-Identifier: MIT
/// One smooth piece of a model: a spline surface without creases or gaps inside, and its neighbours across its four
/// sides.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/spline/surface.hpp"

namespace hapticd::trace {

/// Sides and corners of the parameter rectangle. Side 0: u = lo, 1: u = hi, 2: v = lo, 3: v = hi.
/// Corner 0: (lo, lo), 1: (hi, lo), 2: (lo, hi), 3: (hi, hi).
inline constexpr int kSides = 4;
inline constexpr int kCorners = 4;
/// A set of sides, because a foot point in a corner lies on two sides at once. Bit i is set for side i.
using SideMask = std::uint8_t;
constexpr SideMask bit(int side) {
  return static_cast<SideMask>(1u << side);
}

enum class SideKind : std::uint8_t {
  kFree,    ///< the model ends here
  kJoined,  ///< another patch, or the same one across a seam, continues here
  kPole     ///< the whole side is one point, such as the apex of a cone or the pole of a sphere
};

/// Directions in which a patch leaves its pole. They let a foot that has reached the pole leave it again.
struct PoleFan {
  static constexpr int kRays = 32;
  std::array<double, kRays> along;               ///< parameter of each ray along the collapsed side
  std::array<Eigen::Vector3d, kRays> direction;  ///< unit tangent of each ray, into the patch
  std::array<double, kRays> speed;  ///< [m] length in space per unit of the parameter across the collapsed side
  int patch = -1, side = -1;        ///< patch and side that have this pole
  int next = -1;                    ///< index of the next fan around the same point; the fans of a point form a ring
};

struct Side {
  SideKind kind = SideKind::kFree;
  bool flipped = false;  ///< true if the neighbour's parameter runs in the opposite direction
  int patch = -1;        ///< index of the neighbour, only for kJoined
  int side = -1;         ///< number of the neighbour's side, only for kJoined
  int pole = -1;         ///< index of the PoleFan, only for kPole
};

struct Patch {
  spline::Surface surface;
  Eigen::Array2d lo, hi;     ///< parameter rectangle, in the parameters of the model file
  Eigen::Array3d low, high;  ///< [m] corners of a box around the patch
  double sign = 1;           ///< outward normal = sign * Su x Sv
  int source = 0;            ///< index of the surface in the model file
  int shell = 0;  ///< index of the shell; patches that are joined, directly or through others, have the same shell
  std::array<Side, kSides> sides;
  std::array<int, kCorners> corners{};  ///< index of the model's vertex at each corner

  const Side& side(int number) const noexcept { return sides[static_cast<std::size_t>(number)]; }
  Side& side(int number) noexcept { return sides[static_cast<std::size_t>(number)]; }
  /// [any] Returns the parameter that is constant on a side: 0 (u) or 1 (v).
  static constexpr int axisOf(int side) { return side / 2; }
  /// [any] Returns (u, v) of the point at `fraction` (0 to 1) along a side.
  Eigen::Array2d onSide(int side, double fraction) const noexcept {
    const int axis = axisOf(side);
    Eigen::Array2d uv;
    uv[axis] = side % 2 == 0 ? lo[axis] : hi[axis];
    uv[1 - axis] = lo[1 - axis] + fraction * (hi[1 - axis] - lo[1 - axis]);
    return uv;
  }
  /// [any] Returns the fraction (0 to 1) along a side of its point (u, v).
  double fractionOn(int side, const Eigen::Array2d& uv) const noexcept {
    const int along = 1 - axisOf(side);
    return (uv[along] - lo[along]) / (hi[along] - lo[along]);
  }
  /// [any] Returns the corners at the two ends of a side, in the direction of its parameter.
  static constexpr std::array<int, 2> endsOf(int side) {
    constexpr std::array<std::array<int, 2>, kSides> kEnds = {{{0, 2}, {1, 3}, {0, 1}, {2, 3}}};
    return kEnds[static_cast<std::size_t>(side)];
  }
  /// [any] True if the surface continues beyond one of these sides. Then a foot point there may not be a local minimum
  /// of the distance.
  bool continuesBeyond(SideMask mask) const noexcept {
    for (int i = 0; i < kSides; ++i)
      if ((mask & bit(i)) && side(i).kind != SideKind::kFree) return true;
    return false;
  }
  /// [any] Returns the sides on which the point (u, v) lies.
  SideMask sidesAt(const Eigen::Array2d& uv) const noexcept {
    SideMask mask = 0;
    for (int side = 0; side < kSides; ++side)
      if (uv[axisOf(side)] == (side % 2 == 0 ? lo : hi)[axisOf(side)]) mask |= bit(side);
    return mask;
  }
  /// [any] Returns a lower bound of the distance [m] from `p` to the patch.
  double atLeast(const Eigen::Vector3d& p) const noexcept {
    return (low - p.array()).max(p.array() - high).max(0).matrix().norm();
  }
  /// [any] Returns the outward unit normal. If the tangents vanish (at a pole), returns the normal a little further
  /// inside.
  Eigen::Vector3d normalAt(const Eigen::Array2d& uv) const noexcept;
};

}  // namespace hapticd::trace
