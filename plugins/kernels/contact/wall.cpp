// SPDX-License-Identifier: MIT
#include "kernels/contact/wall.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::contact {

namespace {

/// Returns (x/x0)^n. The common exponents are computed exactly and cheaply. For a root, two roots are divided: the root
/// of the quotient would lose precision at the smallest depths.
double shape(const WallLaw& law, double depth) noexcept {
  if (law.exponent == 1) return depth / law.depth_scale;
  if (law.exponent == 0.5) return std::sqrt(depth) / std::sqrt(law.depth_scale);
  return std::pow(depth / law.depth_scale, law.exponent);
}

}  // namespace

WallForce wallForce(const WallLaw& law, double depth, double closing_speed) noexcept {
  if (!(depth > 0)) return {};
  if (!std::isfinite(closing_speed)) closing_speed = 0;  // then only the spring acts
  const double at_scale = law.stiffness * law.depth_scale + law.damping * closing_speed;
  const double share = shape(law, depth);
  const double force = at_scale * share;
  return {std::max(0.0, force), law.exponent * force / depth, law.damping * share};
}

double wallSlopeAt(const WallLaw& law, double force) noexcept {
  if (law.exponent <= 1) return law.stiffness;
  const double share = force / (law.stiffness * law.depth_scale);  // (x/x0)^n at this force
  return law.exponent * law.stiffness * std::pow(share, 1 - 1 / law.exponent);
}

double wallDepthAt(const WallLaw& law, double force) noexcept {
  if (!(force > 0)) return 0;
  return law.depth_scale * std::pow(force / (law.stiffness * law.depth_scale), 1 / law.exponent);
}

double wallEnergy(const WallLaw& law, double depth) noexcept {
  if (!(depth > 0)) return 0;
  const double elastic = law.stiffness * law.depth_scale * shape(law, depth);
  return elastic * depth / (law.exponent + 1);
}

}  // namespace hapticd::contact
