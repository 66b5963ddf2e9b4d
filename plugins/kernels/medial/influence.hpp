// SPDX-License-Identifier: MIT
/// Which control points a displaced point of a spline moves, and how far (Corso et al. 2002, section 3.3).
#pragma once
#include <array>
#include <span>

namespace hapticd::medial {

/// Highest degree of a skeleton.
inline constexpr int kMaxSkeletonDegree = 5;

/// Weights of consecutive control points along one direction; `first` is the index of the first of them.
struct Influence {
  int first = 0, count = 0;
  std::array<double, kMaxSkeletonDegree + 1> basis{};  ///< B_i: values of the basis functions at the point
  std::array<double, kMaxSkeletonDegree + 1> alpha{};  ///< B_i / (sum of B^2), so that the sum of alpha_i B_i is 1
};

/// How p' of the p + 1 control points that act on a point are chosen.
enum class PointSelection {
  /// takes the p' control points in the middle. The paper's index range, corrected: k - (p + p' - 1) / 2 .. k - (p + 1
  /// - p') / 2
  kCentral,
  /// takes the p' neighbouring control points with the largest sum of squared basis values; the weights stay bounded
  /// even at clamped ends
  kLargest
};

/// [any] Returns the weights with which a point moves p' control points (`p_prime`, clamped to 1 .. p + 1). With p' = p
/// + 1 both choices agree, and the weights are continuous from span to span.
/// @param basis the p + 1 values of the basis functions at the point
/// @param span k, the knot span of the point
Influence influence(std::span<const double> basis, int span, int p_prime, PointSelection choice) noexcept;

/// How skeleton and radius share a contact of depth delta. The skeleton moves by split * delta, and the radius shrinks
/// by (1 - split) * delta. So the touched side always moves by delta. The opposite side moves by (1 - 2 split) delta
/// toward the contact; if this is negative, it moves away.
struct Split {
  double skeleton = 0;  ///< [m] motion of the skeleton along the inward normal of the contact
  double radius = 0;    ///< [m] length by which the radius shrinks
};

/// [any] Returns the shares for the paper's factor g = `split`. 0: only the radius gives way; 1/2: the opposite side
/// stays in place; 1: the whole body moves.
inline Split splitDepth(double delta, double split) noexcept {
  return {split * delta, (1 - split) * delta};
}

}  // namespace hapticd::medial
