// SPDX-License-Identifier: MIT
/// Bounds of how a leaf (a piece of a curved face) bends. They show how many feet a probe has on the leaf without
/// computing the feet, even if the probe is beyond a centre of curvature.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

#include "kernels/brep/geometry.hpp"
#include "kernels/brep/row_box.hpp"

namespace hapticd::brep {

/// A leaf in the frame of its middle: the axes are the principal directions and the normal there. S is a point of the
/// leaf, and S_i, S_ij are its derivatives along directions i and j; the parameters change by along[i] per metre of
/// direction i. Half of the squared distance to a probe p has the derivatives (S - p) S_i and S_i S_j + (S - p) S_ij.
/// Both are linear in p. So each is the sum of its value for a fixed point o and of (o - p) S_i or (o - p) S_ij. The
/// value for o hardly changes over the leaf if o is the centre of curvature, and the vectors S_i and S_ij stay near
/// their values in the middle.
struct LeafCurvature {
  /// Bounds of one such derivative over the leaf. Its value for the point o is in [low, high], and each component of
  /// the vector that multiplies (o - p) is within `off` of `middle`. Stored in single precision because a part has many
  /// leaves; the bounds include the rounding.
  struct Term {
    float low = 0, high = 0;
    Eigen::Vector3f middle{0, 0, 0}, off{0, 0, 0};
  };

  Eigen::Vector3d center{0, 0, 0};  ///< [m] point of the leaf at the middle of its parameters
  /// Rows: unit vectors of the two principal directions and of the normal.
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  Eigen::Array2d along[2]{{0, 0}, {0, 0}};  ///< [1/m] change of (u, v) per metre along direction 1 and 2
  double principal[2]{0, 0};                ///< [1/m] the two principal curvatures in the middle
  /// [m] height of the point o (see above) along the normal, for direction i: the centre of curvature, or 0 if the leaf
  /// is nearly straight in that direction. NaN if the leaf was not measured; then the number of feet is unknown.
  double focus[2]{kUnknown, kUnknown};
  Term slope[2];        ///< bounds of (S - o) S_i
  Term second[2];       ///< bounds of S_i S_i + (S - o) S_ii
  Term mixed;           ///< bounds of S_1 S_2 + (S - center) S_12
  bool smooth = false;  ///< true if the surface goes on smoothly beyond each border, or ends there

  /// [any] Returns the point p in the frame of the leaf.
  Eigen::Vector3d local(const Eigen::Vector3d& p) const noexcept { return frame * (p - center); }

  static constexpr double kEndless = std::numeric_limits<double>::infinity();
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

/// [main] Measures the piece of a surface between two corners of a parameter rectangle. Nothing is measured (see
/// `focus`) if the surface is not regular in the middle, and for offsets, whose second derivatives are not exact.
/// @param ends Leaf::borders @param hull becomes a box that encloses the piece, in the frame of its middle; it stays
/// unchanged if nothing is measured
LeafCurvature leafCurvature(const Geometry& geometry, std::uint32_t surface, const Eigen::Array2d& lo,
                            const Eigen::Array2d& hi, std::uint32_t ends, OrientedBox& hull);

enum class FeetOfLeaf : std::uint8_t {
  kNowhere,  ///< no nearest point of a smooth surface lies on the leaf
  kOne,      ///< the distance has one minimum on the leaf, inside or on its border
  kUnknown
};

/// How many feet a probe has on a leaf, as far as the bounds show it.
struct LeafFeet {
  FeetOfLeaf number = FeetOfLeaf::kUnknown;
  /// For kOne: lower bound of the second derivative of half the squared distance, in any direction.
  double least_second = 0;
};

/// [rt] Returns how many feet a probe has on the leaf. @param q [m] the probe in the frame of the leaf
LeafFeet countFeet(const LeafCurvature& curvature, const Eigen::Vector3d& q) noexcept;

/// [rt] Returns (u, v) near the foot, as a start for Newton's method; it may lie outside the leaf. @param middle (u, v)
/// in the middle of the leaf
Eigen::Array2d footNear(const LeafCurvature& curvature, const Eigen::Array2d& middle,
                        const Eigen::Vector3d& q) noexcept;

}  // namespace hapticd::brep
