// SPDX-License-Identifier: MIT
/// A flat disc around a row of triangles. The triangles of a row lie nearly in one plane, so the disc is much tighter
/// than their box.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "kernels/brep/tree/box_tree.hpp"
#include "kernels/brep/tree/lanes.hpp"
#include "kernels/part/part.hpp"

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

/// The center of an unused place along axis 0 [m]. It is farther away than any disc, and its square is still a finite
/// float.
inline constexpr float kUnused = 1e18F;

/// [rt] Makes place `lane` of four unused.
inline void putNothing(int lane, FourDiscs& to) noexcept {
  to.center[0][lane] = kUnused;
  to.half[lane] = to.radius[lane] = 0;
}

/// [rt] Returns four discs side by side.
inline FourDiscs fourOf(const RowDisc& a, const RowDisc& b, const RowDisc& c, const RowDisc& d) noexcept {
  struct Halves {
    Float4 first, second;
  };
  static_assert(sizeof(RowDisc) == sizeof(Halves));
  const auto ha = std::bit_cast<Halves>(a), hb = std::bit_cast<Halves>(b), hc = std::bit_cast<Halves>(c),
             hd = std::bit_cast<Halves>(d);
  Float4 first[4], second[4];
  transpose(ha.first, hb.first, hc.first, hd.first, first);
  transpose(ha.second, hb.second, hc.second, hd.second, second);
  return {{first[0], first[1], first[2]}, {first[3], second[0], second[1]}, second[2], second[3]};
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

/// Planes that part a probe from four discs.
struct DiscPlanes {
  Float4 normal[3];  ///< toward the probe, not longer than 1; zero if the probe is in the disc
  Float4 distance;   ///< [m] from the probe to the plane, rounded down
};

/// [rt] Returns planes across the ways from the probe to the nearest points of four discs.
inline DiscPlanes discPlanes(const FourDiscs& discs, const BoxProbe& probe) noexcept {
  constexpr Float4 kZero{}, kTiny = kZero + 1e-30F;
  const auto positive = [](const Float4& x) { return x > kZero ? x : kZero; };
  const auto lengthOf = [](const Float4* v) { return squareRoots(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); };
  Float4 way[3], aside[3], normal[3], across[3], off{}, turn{}, along{};
  for (int axis = 0; axis < 3; ++axis) {
    way[axis] = probe.at[axis] - discs.center[axis];
    off += way[axis] * discs.normal[axis];
  }
  for (int axis = 0; axis < 3; ++axis) aside[axis] = way[axis] - off * discs.normal[axis];
  const Float4 radius = lengthOf(aside) + kTiny;
  const Float4 high = positive((off > kZero ? off : -off) - discs.half), signed_high = off > kZero ? high : -high;
  const Float4 beyond = positive(radius - discs.radius) / radius;
  for (int axis = 0; axis < 3; ++axis) normal[axis] = signed_high * discs.normal[axis] + beyond * aside[axis];
  const Float4 share = (1 - 1e-6F) / (lengthOf(normal) + kTiny);
  for (int axis = 0; axis < 3; ++axis) {
    normal[axis] *= share;
    turn += normal[axis] * discs.normal[axis];
    along += normal[axis] * way[axis];
  }
  for (int axis = 0; axis < 3; ++axis) across[axis] = normal[axis] - turn * discs.normal[axis];
  // how far the disc reaches along the normal; this holds for every normal, so its own rounding does not matter
  const Float4 extent = (turn > kZero ? turn : -turn) * discs.half + lengthOf(across) * discs.radius;
  const Float4 rounding = 4e-6F * (lengthOf(way) + discs.half + discs.radius);
  return {{normal[0], normal[1], normal[2]}, along - extent - rounding};
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
