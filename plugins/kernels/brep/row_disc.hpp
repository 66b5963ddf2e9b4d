// SPDX-License-Identifier: MIT
/// A flat disc around a row of triangles. The triangles of a row lie nearly in one plane, so the disc is much tighter
/// than their box.
#pragma once
#include <cmath>
#include <cstdint>
#include <span>

#include "kernels/brep/box_tree.hpp"
#include "kernels/brep/part.hpp"

namespace hapticd::brep {

/// A disc about `center` (in the coordinates of its tree's nodes): no point inside is farther than `half` from its
/// plane and `radius` from its axis [m].
struct RowDisc {
  float center[3]{}, normal[3]{};
  float half = 0, radius = 0;
};

/// Four discs, whose distances are computed at once.
struct alignas(64) FourDiscs {
  Float4 center[3], normal[3];
  Float4 half, radius;
};

/// [rt] Returns four unused places, which are farther away than any disc.
inline FourDiscs emptyFour(const RowDisc&) noexcept {
  constexpr float kFar = 1e18F;  // its square is still a finite float
  FourDiscs discs{};
  discs.center[0] = Float4{} + kFar;
  return discs;
}

/// [rt] Writes a disc to place `lane` of four.
inline void put(const RowDisc& disc, int lane, FourDiscs& to) noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    to.center[axis][lane] = disc.center[axis];
    to.normal[axis][lane] = disc.normal[axis];
  }
  to.half[lane] = disc.half;
  to.radius[lane] = disc.radius;
}

/// [main] Returns a disc around the given triangles of a part, at most BoxTree::kMaxRow of them.
RowDisc rowDisc(const Part& part, std::span<const std::uint32_t> triangles, const BoxTree& tree);

/// Safety factor of the bounds: rounding of the normal and of the vector to the probe changes a bound by less than 1e-5
/// of it.
inline constexpr float kDiscShare = 1 - 1e-5F;

/// [rt] Returns lower bounds of the squared distances [m^2] to the contents of four discs.
inline Float4 rowDistances(const FourDiscs& discs, const BoxProbe& probe) noexcept {
  constexpr Float4 kZero{};
  Float4 off{}, whole{};
  for (int axis = 0; axis < 3; ++axis) {
    const Float4 way = probe.at[axis] - discs.center[axis];
    off += way * discs.normal[axis];
    whole += way * way;
  }
  Float4 across2 = whole * (1 - 2e-6F) - off * off;
  across2 = across2 > kZero ? across2 : kZero;
  Float4 across = squareRoots(across2) - discs.radius;
  Float4 high = (off > kZero ? off : -off) - discs.half;
  high = high > kZero ? high : kZero;
  across = across > kZero ? across : kZero;
  return (high * high + across * across) * kDiscShare;
}

/// [rt] Returns a lower bound of the squared distance [m^2] to the contents of one disc.
inline float rowDistance(const RowDisc& disc, const BoxProbe& probe) noexcept {
  float off = 0, whole = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float way = probe.at[axis][0] - disc.center[axis];
    off += way * disc.normal[axis];
    whole += way * way;
  }
  const float across2 = whole * (1 - 2e-6F) - off * off;
  const float high = std::abs(off) - disc.half;
  const float across = (across2 > 0 ? std::sqrt(across2) : 0.0F) - disc.radius;
  return ((high > 0 ? high * high : 0.0F) + (across > 0 ? across * across : 0.0F)) * kDiscShare;
}

}  // namespace hapticd::brep
