// SPDX-License-Identifier: MIT
/// Which control points a displaced point of a spline takes along, and how far (Corso et al. 2002, section 3.3).
#pragma once
#include <array>
#include <span>

namespace hapticd::medial {

/// Highest degree of a skeleton.
inline constexpr int kMaxSkeletonDegree = 5;

/// Weights of consecutive control points along one direction.
struct Influence {
  int first = 0, count = 0;
  std::array<double, kMaxSkeletonDegree + 1> basis{};  ///< B_i at the point
  std::array<double, kMaxSkeletonDegree + 1> alpha{};  ///< B_i / sum B^2: sum of alpha_i B_i is 1
};

/// How the p' of p + 1 control points are chosen.
enum class Choice {
  kCentral,  ///< the middle of the span. The paper's index range, corrected: k - (p + p' - 1) / 2 .. k - (p + 1 - p') /
             ///< 2
  kLargest   ///< the consecutive ones with the largest sum of squared basis values: bounded also at clamped ends
};

/// [any] Influence of the point whose p + 1 = basis.size() basis values on span k are `basis`, over p' control points
/// (clamped to 1 .. p + 1). With p' = p + 1 the choices agree and the weights are continuous from span to span.
Influence influence(std::span<const double> basis, int span, int p_prime, Choice choice) noexcept;

/// How a contact of depth delta is shared by skeleton and radius: the skeleton moves by split * delta, the radius
/// shrinks by (1 - split) * delta. The touched side always moves by delta, the other one by (1 - 2 split) delta.
struct Split {
  double skeleton = 0;  ///< [m] along the inward normal of the contact
  double radius = 0;    ///< [m] by which the radius shrinks
};

/// [any] The paper's g split: 0 only the radius gives way, 1/2 the opposite side stays, 1 the body moves whole.
inline Split splitDepth(double delta, double split) noexcept {
  return {split * delta, (1 - split) * delta};
}

}  // namespace hapticd::medial
