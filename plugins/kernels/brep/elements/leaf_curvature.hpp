// SPDX-License-Identifier: MIT
/// Bounds of how a leaf (a piece of a curved face) bends. They show how many feet a probe has on the leaf without
/// computing the feet, even if the probe is beyond a centre of curvature.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>

#include "kernels/brep/geometry/geometry.hpp"
#include "kernels/brep/tree/coarse.hpp"
#include "kernels/brep/tree/row_box.hpp"

namespace hapticd::brep {

/// A leaf in the frame of its middle: the axes are about the principal directions and the normal there. S is a point of
/// the leaf, and S_i, S_ij are its derivatives along directions i and j; the parameters change by along(i) per metre of
/// direction i. Half of the squared distance to a probe p has the derivatives (S - p) S_i and S_i S_j + (S - p) S_ij.
/// Both are linear in p. So each is the sum of its value for a fixed point o and of (o - p) S_i or (o - p) S_ij. The
/// value for o hardly changes over the leaf if o is the centre of curvature, and the vectors S_i and S_ij stay near
/// their values in the middle.
///
/// A part has many leaves, so the numbers are rounded as far as the bounds allow. Centre, frame and directions are
/// rounded first, and the bounds are measured with the rounded ones: then they are exact for these.
struct LeafCurvature {
  /// Bounds of four of these derivatives over the leaf, in the order slope 1, slope 2, second 11, second 22. The value
  /// for the point o is in [low, high], and each component of the vector that multiplies (o - p) is within `off` of
  /// `middle`. The bounds include all rounding, also that of countFeet().
  struct FourTerms {
    Coarse4 low{}, high{}, middle[3]{}, off[3]{};
  };
  /// The same for the mixed second derivative. Its point o is the centre.
  struct Term {
    Coarse low, high, middle[3], off[3];
  };

  float at[3]{};              ///< [m] the centre, see center()
  float directions[2][2]{};   ///< see along()
  std::int16_t rows[2][3]{};  ///< the first two rows of frame(), times kUnit
  bool smooth = false;        ///< true if the surface goes on smoothly beyond each border, or ends there
  /// [m] height of the point o (see above) along the normal, for direction i: the centre of curvature, or 0 if the leaf
  /// is nearly straight in that direction. NaN if the leaf was not measured; then the number of feet is unknown.
  float focus[2]{kUnknown, kUnknown};
  FourTerms terms;
  Term mixed;  ///< bounds of S_1 S_2 + (S - center) S_12

  /// [any] Returns a point near the middle of the leaf [m].
  Eigen::Vector3d center() const noexcept {
    return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
  }
  /// [any] Returns the change of (u, v) per metre along direction i.
  Eigen::Array2d along(int i) const noexcept {
    return {static_cast<double>(directions[i][0]), static_cast<double>(directions[i][1])};
  }
  /// [any] Returns the rows of the frame: the two principal directions and the normal, nearly at right angles and of
  /// nearly unit length.
  Eigen::Matrix3d frame() const noexcept {
    Eigen::Matrix3d axes;
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 3; ++k) axes(i, k) = rows[i][k] * (1 / kUnit);
    axes.row(2) = axes.row(0).cross(axes.row(1));
    return axes;
  }
  /// [any] Returns the point p in the frame of the leaf.
  Eigen::Vector3d local(const Eigen::Vector3d& p) const noexcept { return frame() * (p - center()); }
  /// [any] Returns about the principal curvature i in the middle [1/m].
  double principal(int i) const noexcept { return static_cast<double>(terms.middle[2].of[2 + i].value()); }

  static constexpr double kUnit = 32767;
  static constexpr double kEndless = std::numeric_limits<double>::infinity();
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
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
