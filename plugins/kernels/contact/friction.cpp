// SPDX-License-Identifier: MIT
#include "kernels/contact/friction.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::contact {

Eigen::Vector3d Friction::step(const FrictionLaw& law, const Eigen::Vector3d& foot, const Eigen::Vector3d& normal,
                               double normal_force, const Eigen::Vector3d& velocity) noexcept {
  if (!(normal_force > 0) || !std::isfinite(normal_force) || !foot.allFinite() || !normal.allFinite()) {
    reset();
    return Eigen::Vector3d::Zero();
  }
  const auto along = [&normal](const Eigen::Vector3d& a) { return Eigen::Vector3d(a - normal.dot(a) * normal); };
  Eigen::Vector3d drag = Eigen::Vector3d::Zero();
  if (law.viscosity > 0 && velocity.allFinite()) drag = -law.viscosity * along(velocity);
  if (!(law.static_coefficient > 0) || !(law.stiffness > 0)) return drag;

  if (!stuck_) {
    stretch_.setZero();
    weakened_ = 0;
    stuck_ = true;
  } else {
    // projected on the surface: if the surface turns, stretch is lost and never gained
    stretch_ = along(stretch_ + foot - foot_);
  }
  foot_ = foot;

  const double lowest = std::min(law.dynamic_coefficient, law.static_coefficient);
  const double coefficient = law.static_coefficient + (lowest - law.static_coefficient) * weakened_;
  const double limit = coefficient * normal_force / law.stiffness;  // [m] limit of the stretch
  const double length = stretch_.norm();
  slipping_ = length > limit;
  if (slipping_) {
    stretch_ *= limit / length;
    const double slip_length = law.static_coefficient * normal_force / law.stiffness;
    weakened_ = 1 - (1 - weakened_) * std::exp(-(length - limit) / slip_length);
  } else if (law.stiffness * length < lowest * normal_force) {
    weakened_ = 0;
  }
  return drag - law.stiffness * stretch_;
}

}  // namespace hapticd::contact
