#include "nurbs_rigid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace hapticd {

void NurbsRigid::activate(const hsp_activation& activation, hsp_report& report) {
  if (motion_ == kDynamic)
    throw std::invalid_argument("motion: dynamic is not available in this version, expected static or kinematic");
  load(activation, report);
  report.max_stiffness = stiffness_;
  if (damping_ > 0 || viscosity_ > 0) report.flags |= HSP_R_VELOCITY;
  const bool rubs = friction_static_ > 0 || friction_dynamic_ > 0 || viscosity_ > 0;
  friction_.assign(rubs ? std::max(activation.max_probes, 1u) : 0, contact::Friction{});
}

void NurbsRigid::reset() noexcept HSP_RT {
  TracedShape::reset();
  for (contact::Friction& friction : friction_) friction.reset();
}

hsp_status NurbsRigid::touch(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
  const Touch touch = trace(probe, step, contact);
  const uint32_t index = indexOf(probe, step);
  const double depth = touch.depth + (texture_amplitude_ > 0 ? texture(touch.foot) : 0);
  if (!touch.traced || touch.depth <= 0 || depth <= 0) {
    if (index < friction_.size()) friction_[index].reset();
    return touch.status;
  }
  const Eigen::Vector3d velocity(probe.velocity);
  const contact::WallLaw law{stiffness_, damping_, exponent_, depth_scale_};
  const contact::WallForce wall = contact::wallForce(law, depth, -velocity.dot(touch.normal));
  Eigen::Vector3d force = wall.force * touch.normal;
  if (index < friction_.size()) force += along(touch, velocity, wall.force, friction_[index]);
  Eigen::Map<Eigen::Vector3d>(contact.force) = force;
  contact.stiffness = std::isfinite(wall.stiffness) ? wall.stiffness : stiffness_;
  if (pop_through_ > 0 && wall.force > pop_through_) popThrough(index);
  return touch.status;
}

/// What the surface does along itself: dry friction and drag.
Eigen::Vector3d NurbsRigid::along(const Touch& touch, const Eigen::Vector3d& velocity, double wall_force,
                                  contact::Friction& friction) const noexcept HSP_RT {
  const contact::FrictionLaw law{std::max(friction_static_, friction_dynamic_), friction_dynamic_, stiffness_,
                                 viscosity_};
  return friction.step(law, touch.foot.point, touch.normal, wall_force, velocity);
}

/// Height [m] of the ridges at a foot: a product of two waves along the model's axes would swim on a moving foot, so
/// the waves run over the foot point itself, in the model's frame.
double NurbsRigid::texture(const trace::Foot& foot) const noexcept HSP_RT {
  const Eigen::Array3d phase = foot.point.array() * (2 * std::numbers::pi / texture_wavelength_);
  return texture_amplitude_ * (std::sin(phase.x()) + std::sin(phase.y()) + std::sin(phase.z())) / 3;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::NurbsRigid)
