#include "nurbs_rigid.hpp"

#include <cmath>

namespace hapticd {

void NurbsRigid::activate(const hsp_activation& activation, hsp_report& report) {
  load(activation, report);
  report.max_stiffness = stiffness_;
  if (damping_ > 0 || viscosity_ > 0) report.flags |= HSP_R_VELOCITY;
}

hsp_status NurbsRigid::touch(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
  const Touch touch = trace(probe, step, contact);
  if (!touch.traced || touch.depth <= 0) return touch.status;
  const Eigen::Vector3d velocity(probe.velocity);
  const double outward_speed = velocity.dot(touch.normal);
  const contact::WallLaw law{stiffness_, damping_, exponent_, depth_scale_};
  const contact::WallForce wall = contact::wallForce(law, touch.depth, -outward_speed);
  const Eigen::Vector3d sliding = velocity - outward_speed * touch.normal;
  Eigen::Map<Eigen::Vector3d>(contact.force) = wall.force * touch.normal - viscosity_ * sliding;
  contact.stiffness = std::isfinite(wall.stiffness) ? wall.stiffness : stiffness_;
  if (pop_through_ > 0 && wall.force > pop_through_) popThrough(indexOf(probe, step));
  return touch.status;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::NurbsRigid)
