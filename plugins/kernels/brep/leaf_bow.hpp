// SPDX-License-Identifier: MIT
/// How a leaf bends: what a probe sees of it is told without looking for a foot, also from beyond a centre of
/// curvature.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "kernels/brep/geometry.hpp"
#include "kernels/brep/row_box.hpp"

namespace hapticd::brep {

/// A leaf in the frame of its middle: the principal directions and the normal there. Along direction i, in which the
/// parameters grow by along[i] per metre, half of the squared distance to p has the derivatives
/// (S - p) S_i and S_i S_j + (S - p) S_ij. They are linear in p: about a point o they are those of o, which hardly
/// change over the leaf where o is the centre of curvature, and (o - p) S_i and (o - p) S_ij, known in the middle.
struct LeafBow {
  /// Range of an expression `about` o and vectors that (o - p) is multiplied with: `middle` within `off` by component.
  /// In single precision, whose rounding is in the range: a part has many leaves.
  struct Term {
    float low = 0, high = 0;
    Eigen::Vector3f middle{0, 0, 0}, off{0, 0, 0};
  };

  Eigen::Vector3d center{0, 0, 0};                      ///< [m] S in the middle of the parameters
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< rows: directions 1 and 2, and the normal; unit
  Eigen::Array2d along[2]{{0, 0}, {0, 0}};              ///< [1/m]
  double bent[2]{0, 0};                                 ///< [1/m] curvature along them in the middle
  double focus[2]{kUnknown, kUnknown};  ///< [m] o of direction i, on the normal; not a number: nothing is known
  Term slope[2];                        ///< (S - o) S_i
  Term bend[2];                         ///< S_i S_i + (S - o) S_ii
  Term twist;                           ///< S_1 S_2 + (S - center) S_12
  bool smooth = false;                  ///< each border is inside a smooth surface, or the surface ends there

  /// [any] A point in the frame.
  Eigen::Vector3d local(const Eigen::Vector3d& p) const noexcept { return frame * (p - center); }

  static constexpr double kEndless = std::numeric_limits<double>::infinity();
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

/// [main] Of the piece of a surface between two corners of a parameter rectangle. Nothing is known of a piece whose
/// middle is not regular, and of offsets, whose second derivatives are not exact. @param ends Leaf::borders @param hull
/// becomes what holds the piece, in the frame of its middle; stays if nothing is known
LeafBow leafBowOf(const Geometry& geometry, std::uint32_t surface, const Eigen::Array2d& lo, const Eigen::Array2d& hi,
                  std::uint32_t ends, TurnedBox& hull);

enum class FeetOfLeaf : std::uint8_t {
  kNowhere,  ///< no nearest point of a smooth surface lies there
  kOne,      ///< the distance has one minimum, inside or on the border
  kUnknown
};

/// How a probe sees a leaf.
struct LeafSight {
  FeetOfLeaf feet = FeetOfLeaf::kUnknown;
  double least_bend = 0;  ///< for kOne: the least second derivative of half the squared distance, in any direction
};

/// [rt] How a probe sees the leaf. @param q [m] the probe in the frame of the leaf
LeafSight feetSeenFrom(const LeafBow& bow, const Eigen::Vector3d& q) noexcept;

/// [rt] (u, v) near the foot; may lie outside the leaf. @param middle (u, v) in the middle of the leaf
Eigen::Array2d footNear(const LeafBow& bow, const Eigen::Array2d& middle, const Eigen::Vector3d& q) noexcept;

}  // namespace hapticd::brep
