// SPDX-License-Identifier: MIT
/// A box around one element, with the axes of the element. Elements are nearly flat or straight, so this box is much
/// tighter than the upright box in the tree.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/brep/tree/box_tree.hpp"
#include "kernels/brep/tree/lanes.hpp"

namespace hapticd::brep {

/// A box in a frame of its own, in double precision. If the shape is an arc about a line parallel to axis 1, it fills
/// only a thin part of its box. So the shape is also bounded by two cylinders about that line.
struct OrientedBox {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< rows: unit axes at right angles
  Eigen::AlignedBox3d box;                              ///< the box in the coordinates frame * x
  Eigen::Vector2d focus{0, 0};                          ///< position of the line, along axes 0 and 2
  double inner = 0;  ///< [m] radius of the inner cylinder; `outer` is the radius of the outer one
  double outer = std::numeric_limits<double>::infinity();

  /// [main] Returns the upright box around this box.
  Eigen::AlignedBox3d axisAligned() const;
};

/// A OrientedBox as a search uses it: in single precision, in the coordinates of its tree's nodes [m]. It fills one
/// line of the cache.
struct alignas(64) RowBox {
  Float4 first{0, 0, 0, -kWhole};  ///< axis 0, then the radius of the inner cylinder
  Float4 second{0, 0, 0, kWhole};  ///< axis 1, then the radius of the outer cylinder
  /// The center, then the position of the cylinders' line along axis 0, from the center.
  Float4 center{};
  Float4 half{};  ///< half size along each axis, then the position of the cylinders' line along axis 2

  /// [any] Returns axis 2, the cross product of the other two.
  Float4 third() const noexcept {
    const Float4 a = first, b = second;
    return Float4{a[1], a[2], a[0], 0} * Float4{b[2], b[0], b[1], 0} -
           Float4{a[2], a[0], a[1], 0} * Float4{b[1], b[2], b[0], 0};
  }

  static constexpr float kWhole = 1e18F;  ///< means "no bound"; its square is still a finite float
};

/// Four RowBoxes, whose distances are computed at once.
struct alignas(64) FourRowBoxes {
  Float4 center[3], axis[3][3];
  Float4 half[3];
  Float4 focus[2], inner, outer;
};

/// [rt] Makes place `lane` of four unused.
inline void putNothing(int lane, FourRowBoxes& to) noexcept {
  to.half[0][lane] = -RowBox::kWhole;
}

/// [rt] Returns four boxes side by side.
inline FourRowBoxes fourOf(const RowBox& a, const RowBox& b, const RowBox& c, const RowBox& d) noexcept {
  Float4 first[4], second[4], center[4], half[4];
  transpose(a.first, b.first, c.first, d.first, first);
  transpose(a.second, b.second, c.second, d.second, second);
  transpose(a.center, b.center, c.center, d.center, center);
  transpose(a.half, b.half, c.half, d.half, half);
  const Float4 third[3] = {first[1] * second[2] - first[2] * second[1], first[2] * second[0] - first[0] * second[2],
                           first[0] * second[1] - first[1] * second[0]};
  return {{center[0], center[1], center[2]},
          {{first[0], first[1], first[2]}, {second[0], second[1], second[2]}, {third[0], third[1], third[2]}},
          {half[0], half[1], half[2]},
          {center[3], half[3]},
          first[3],
          second[3]};
}

/// [main] Rounds a box to single precision. The result encloses the box.
RowBox rowBox(const OrientedBox& oriented, const BoxTree& tree);

/// Safety factor of the bounds: rounding of the axes and of the vector to the probe changes a bound by less than 1e-5
/// of it.
inline constexpr float kRowShare = 1 - 1e-5F;

/// [rt] Returns lower bounds of the squared distances [m^2] to the contents of four boxes.
inline Float4 rowDistances(const FourRowBoxes& boxes, const BoxProbe& probe) noexcept {
  constexpr Float4 kZero{};
  const Float4 way[3] = {probe.at[0] - boxes.center[0], probe.at[1] - boxes.center[1], probe.at[2] - boxes.center[2]};
  Float4 along[3], square[3];
  for (int i = 0; i < 3; ++i) {
    along[i] = way[0] * boxes.axis[i][0] + way[1] * boxes.axis[i][1] + way[2] * boxes.axis[i][2];
    const Float4 beyond = (along[i] > kZero ? along[i] : -along[i]) - boxes.half[i];
    const Float4 beside = beyond > kZero ? beyond : kZero;
    square[i] = beside * beside;
  }
  const Float4 x = along[0] - boxes.focus[0], z = along[2] - boxes.focus[1];
  const Float4 radius = squareRoots(x * x + z * z);
  const Float4 inside = boxes.inner - radius, outside = radius - boxes.outer;
  const Float4 either = inside > outside ? inside : outside;
  const Float4 beside = either > kZero ? either : kZero;
  const Float4 bent = beside * beside, flat = square[0] + square[2];
  return ((bent > flat ? bent : flat) + square[1]) * kRowShare;
}

/// [rt] Returns a lower bound of the squared distance [m^2] to the contents of one box.
inline float rowDistance(const RowBox& box, const BoxProbe& probe) noexcept {
  constexpr Float4 kZero{};
  const Float4 way = Float4{probe.at[0][0], probe.at[1][0], probe.at[2][0], 0} - box.center;
  const Float4 a = way * box.first, b = way * box.second, c = way * box.third();
  const Float4 along = Float4{a[0], b[0], c[0], 0} + Float4{a[1], b[1], c[1], 0} + Float4{a[2], b[2], c[2], 0};
  const Float4 beyond = (along > kZero ? along : -along) - box.half, beside = beyond > kZero ? beyond : kZero;
  const Float4 square = beside * beside;
  const float x = along[0] - box.center[3], z = along[2] - box.half[3];
  const float radius = std::sqrt(x * x + z * z);
  const float bent = std::max(std::max(box.first[3] - radius, radius - box.second[3]), 0.0F);
  return (std::max(bent * bent, square[0] + square[2]) + square[1]) * kRowShare;
}

}  // namespace hapticd::brep
