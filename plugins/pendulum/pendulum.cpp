#include "pendulum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "kernels/contact/wall.hpp"

namespace hapticd {

void Pendulum::activate(const hsp_activation& activation, hsp_report& report) {
  load(activation, report);
  axis_model_ = Eigen::Vector3d(axis_.data());
  if (!(axis_model_.norm() > 0)) throw std::invalid_argument("pendulum: axis: expected a direction, got [0, 0, 0]");
  axis_model_.normalize();
  drawn_ = MovingFrame::of(activation.pose);
  axis_world_ = drawn_.orientation * axis_model_;
  pivot_world_ = drawn_.position + drawn_.orientation * Eigen::Vector3d(pivot_.data());
  const Eigen::Vector3d gravity(activation.gravity);
  const double inertia = inertia_ > 0 ? inertia_ : mass_ * length_ * length_;
  law_ = {mass_, inertia, length_, damping_, (gravity - gravity.dot(axis_world_) * axis_world_).norm()};
  if (!(inertia > 0))
    throw std::invalid_argument(
        "pendulum: inertia: a point mass of length 0 has none; expected inertia or length above 0");
  dynamics::validate(law_);
  state_ = {angle_, rate_};
  torque_ = stored_ = 0;
  probes_.emplace(std::max(activation.max_probes, 1u));
  report.max_stiffness = stiffness_;
  report.flags |= HSP_R_MOVES;
  if (contact_damping_ > 0) report.flags |= HSP_R_VELOCITY;
}

void Pendulum::reset() noexcept HSP_RT {
  TracedShape::reset();
  torque_ = 0;
}

/// Turned by an angle from the drawing, never by steps: whatever the number of ticks the pose has the angle's error
/// only.
MovingFrame Pendulum::frame() const noexcept HSP_RT {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(std::remainder(state_.angle, 2 * M_PI), axis_world_));
  MovingFrame now;
  now.orientation = (turn * drawn_.orientation).normalized();
  now.position = pivot_world_ + turn * (drawn_.position - pivot_world_);
  now.angular = state_.rate * axis_world_;
  now.linear = now.angular.cross(now.position - pivot_world_);
  return now;
}

hsp_status Pendulum::step(const hsp_step& step) noexcept HSP_RT {
  const MovingFrame before = MovingFrame::of(*step.pose);
  state_ = dynamics::advance(law_, state_, torque_, step.dt_s);
  const MovingFrame now = frame();
  now.write(*step.pose);
  const hsp_step moved = probes_->step(step, before, now);
  const contact::WallLaw wall_law{stiffness_, contact_damping_, exponent_, depth_scale_};
  hsp_status worst = HSP_OK;
  torque_ = stored_ = 0;
  for (uint32_t i = 0; i < moved.count; ++i) {
    const hsp_probe& probe = *HSP_AT(const hsp_probe, moved.in, moved.in_stride, i);
    hsp_contact& contact = *HSP_AT(hsp_contact, step.out, step.out_stride, i);
    const Touch touch = trace(probe, moved, contact);
    if (touch.status < 0 || (worst == HSP_OK && touch.status > 0)) worst = touch.status;
    if (!touch.traced || touch.depth <= 0) continue;
    const auto wall = contact::wallForce(wall_law, touch.depth, -Eigen::Vector3d(probe.velocity).dot(touch.normal));
    const Eigen::Vector3d force = wall.force * touch.normal;
    Eigen::Map<Eigen::Vector3d>(contact.force) = force;
    contact.stiffness = std::isfinite(wall.stiffness) ? wall.stiffness : stiffness_;
    stored_ += contact::wallEnergy(wall_law, touch.depth);
    torque_ -= axis_model_.dot((touch.foot.point - Eigen::Vector3d(pivot_.data())).cross(force));
  }
  return worst;
}

const void* Pendulum::extension(const char* name) {
  if (std::string_view(name) != HSP_EXT_ENERGY) return tracedExtension<Pendulum>(name);
  energy_extension_ = {sizeof(hsp_ext_energy), 0, [](hsp_shape* shape) HSP_RT -> double {
                         const Pendulum& self = *reinterpret_cast<Pendulum*>(shape);
                         return dynamics::energy(self.law_, self.state_) + self.stored_;
                       }};
  return &energy_extension_;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::Pendulum)
