// SPDX-License-Identifier: MIT
/// One smooth piece of a model: a spline surface without creases or gaps inside, and what lies across its four sides.
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
/// A foot can lie on several sides at once: bit i stands for side i.
using SideMask = std::uint8_t;
constexpr SideMask bit(int side) {
  return static_cast<SideMask>(1u << side);
}

enum class SideKind : std::uint8_t {
  kFree,    ///< the model ends here
  kJoined,  ///< another patch, or the same one across a seam, continues here
  kPole     ///< the whole side is one point: the apex of a cone, the pole of a sphere
};

/// Directions in which a patch leaves its pole, so that a foot that reaches the pole finds its way out again.
struct PoleFan {
  static constexpr int kRays = 32;
  std::array<double, kRays> along;               ///< parameter along the collapsed side
  std::array<Eigen::Vector3d, kRays> direction;  ///< unit tangent into the patch
  std::array<double, kRays> speed;               ///< [m] of way there for each unit of the parameter across the side
  int patch = -1, side = -1;                     ///< of the model: whose pole it is
  int next = -1;                                 ///< index of another fan around the same point, in a ring
};

struct Side {
  SideKind kind = SideKind::kFree;
  bool flipped = false;  ///< the neighbour's parameter runs the other way
  int patch = -1;        ///< neighbour, kJoined only
  int side = -1;         ///< the neighbour's side
  int pole = -1;         ///< index of the PoleFan, kPole only
};

struct Patch {
  spline::Surface surface;
  Eigen::Array2d lo, hi;     ///< parameter rectangle, in the parameters of the model file
  Eigen::Array3d low, high;  ///< [m] corners of a box around the patch
  double sign = 1;           ///< outward normal = sign * Su x Sv
  int source = 0;            ///< index of the surface in the model file
  int shell = 0;             ///< patches joined directly or through others share a shell
  std::array<Side, kSides> sides;
  std::array<int, kCorners> corners{};  ///< vertices of the model

  /// [any] The fixed parameter of a side: 0 (u) or 1 (v).
  static constexpr int axisOf(int side) { return side / 2; }
  /// [any] (u, v) of the point at `fraction` (0..1) of the way along a side.
  Eigen::Array2d onSide(int side, double fraction) const noexcept {
    const int axis = axisOf(side);
    Eigen::Array2d uv;
    uv[axis] = side % 2 == 0 ? lo[axis] : hi[axis];
    uv[1 - axis] = lo[1 - axis] + fraction * (hi[1 - axis] - lo[1 - axis]);
    return uv;
  }
  /// [any] How far along a side (0..1) the parameters (u, v) on it are.
  double fractionOn(int side, const Eigen::Array2d& uv) const noexcept {
    const int along = 1 - axisOf(side);
    return (uv[along] - lo[along]) / (hi[along] - lo[along]);
  }
  /// [any] The corners at the two ends of a side, in the direction of its parameter.
  static constexpr std::array<int, 2> endsOf(int side) {
    constexpr std::array<std::array<int, 2>, kSides> kEnds = {{{0, 2}, {1, 3}, {0, 1}, {2, 3}}};
    return kEnds[static_cast<std::size_t>(side)];
  }
  /// [any] Whether the surface goes on beyond one of these sides: a foot there may be no bottom of a valley.
  bool goesOn(SideMask mask) const noexcept {
    for (int side = 0; side < kSides; ++side)
      if ((mask & bit(side)) && sides[static_cast<std::size_t>(side)].kind != SideKind::kFree) return true;
    return false;
  }
  /// [any] The sides on which the parameters (u, v) lie.
  SideMask sidesAt(const Eigen::Array2d& uv) const noexcept {
    SideMask mask = 0;
    for (int side = 0; side < kSides; ++side)
      if (uv[axisOf(side)] == (side % 2 == 0 ? lo : hi)[axisOf(side)]) mask |= bit(side);
    return mask;
  }
  /// [any] No point of the patch is nearer to `p` than this [m].
  double atLeast(const Eigen::Vector3d& p) const noexcept {
    return (low - p.array()).max(p.array() - high).max(0).matrix().norm();
  }
  /// [any] Outward unit normal. Where the tangents vanish (a pole), the normal a little further inside.
  Eigen::Vector3d normalAt(const Eigen::Array2d& uv) const noexcept;
};

}  // namespace hapticd::trace
