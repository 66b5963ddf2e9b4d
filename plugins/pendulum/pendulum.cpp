// SPDX-License-Identifier: MIT
#include "pendulum.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string_view>

#include "kernels/contact/wall.hpp"

namespace hapticd {

namespace {

/// Refuses a swing that is too fast to be felt. A contact is computed once per tick. If the pendulum turns by more than
/// a radian between two ticks, it passes through the probe and hits it from any direction.
void checkFelt(double swing_rate, double rate_hz) {
  if (!(rate_hz > 0) || swing_rate <= rate_hz) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "pendulum: it swings at %.4g rad/s, more than 1 rad per tick at %.4g Hz, so a contact with it cannot "
                "be felt; give it a greater length or inertia",
                swing_rate, rate_hz);
  throw std::invalid_argument(text);
}

}  // namespace

/// Returns the pendulum as a rigid body on a hinge, in the model frame at angle 0.
/// A hinge depends on mass and centre only by the weight's moment, mass times length, and by the whole inertia. So the
/// centre is put nearer to the pivot, and the mass is made larger, until half of the inertia remains about the centre:
/// a point mass has none there, which a rigid body must have.
/// @param down unit vector from the pivot to the centre; zero if no gravity acts in the plane of the swing
dynamics::RigidBodyLaw Pendulum::hingeLaw(double inertia, const Eigen::Vector3d& down) const {
  dynamics::RigidBodyLaw law;
  law.joint = dynamics::Joint::kHinge;
  law.pivot = Eigen::Vector3d(pivot_.data());
  law.axis = Eigen::Vector3d(axis_.data());
  law.angular_damping = damping_;
  const double length = down.isZero(0) ? 0 : std::min(length_, inertia / (2 * mass_ * length_));
  law.mass = length > 0 ? mass_ * (length_ / length) : mass_;
  law.center = law.pivot + length * down;
  law.inertia = Eigen::Matrix3d::Identity() * (inertia - law.mass * length * length);
  if (limits_.size() == 2) {
    law.limits = {limits_[0] - angle_, limits_[1] - angle_};  // a body counts from where it starts
    if (limits_[0] < limits_[1] && !(law.limits.lowest <= 0 && law.limits.highest >= 0))
      throw std::invalid_argument(
          "limits: the pendulum starts at `angle`, which is not between its end stops; "
          "expected lowest <= angle <= highest");
  }
  return law;
}

void Pendulum::activate(const hsp_activation& activation, hsp_report& report) {
  load(activation, report);
  const Eigen::Vector3d axis(axis_.data());
  if (!(axis.norm() > 0)) throw std::invalid_argument("axis: [0, 0, 0] has no direction; give one such as [0, 0, 1]");
  const MovingFrame drawn = MovingFrame::of(activation.pose);  // at angle 0
  const Eigen::Vector3d axis_world = drawn.orientation * axis.normalized(), gravity(activation.gravity);
  const Eigen::Vector3d pull = gravity - gravity.dot(axis_world) * axis_world;
  const double inertia = inertia_ > 0 ? inertia_ : mass_ * length_ * length_;
  if (!(inertia > 0))
    throw std::invalid_argument(
        "pendulum: inertia: a point mass at length 0 has no inertia; give an inertia or a length above 0");
  const Eigen::Vector3d down =
      pull.norm() > 0 ? Eigen::Vector3d(drawn.orientation.conjugate() * pull.normalized()) : Eigen::Vector3d::Zero();
  const dynamics::RigidBodyLaw law = hingeLaw(inertia, down);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(std::remainder(angle_, 2 * M_PI), axis_world));
  const Eigen::Vector3d pivot_world = drawn.position + drawn.orientation * law.pivot;
  body_.emplace(law, MovingFrame{pivot_world + turn * (drawn.position - pivot_world), turn * drawn.orientation},
                gravity, activation);
  checkFelt(body_->body().swingRate(), activation.rate_hz);
  body_->setVelocity(Eigen::Vector3d::Zero(), rate_ * axis.normalized());
  const double half = std::sin(angle_ / 2);
  lifted_ = 2 * mass_ * pull.norm() * length_ * half * half;
  stored_ = 0;
  const contact::WallLaw wall{stiffness_, contact_damping_, exponent_, depth_scale_};
  const double force = forceToClaimFor(activation, kUnknownForce);
  report.max_stiffness = stiffness_ > 0 ? contact::wallSlopeAt(wall, force) : 0;
  letGoBeyond(contact::wallDepthAt(wall, force));
  report.flags |= HSP_R_MOVES | HSP_R_PUSHES;
  if (contact_damping_ > 0) report.flags |= HSP_R_VELOCITY;
}

void Pendulum::reset() noexcept HSP_RT {
  TracedShape::reset();
  if (body_) body_->release();
  stored_ = 0;
}

hsp_status Pendulum::step(const hsp_step& given) noexcept HSP_RT {
  const hsp_step step = body_->move(given);
  const uint32_t end = body_->endFlags();
  stored_ = 0;
  return touchEach(step, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t) {
    const hsp_status status = press(probe, step, contact);
    contact.flags |= end;
    return status;
  });
}

hsp_status Pendulum::press(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
  const Touch touch = trace(probe, step, contact);
  if (!touch.traced) return touch.status;
  dynamics::LastContact pressing;
  pressing.probe = Eigen::Vector3d(probe.position);
  pressing.point = touch.foot.point;
  pressing.normal = touch.normal;
  pressing.depth = touch.depth;
  pressing.law = {stiffness_, contact_damping_, exponent_, depth_scale_};
  body_->remember(indexOf(probe, step), pressing);
  if (touch.depth <= 0) return touch.status;
  const double closing_speed = -Eigen::Vector3d(probe.velocity).dot(touch.normal);
  const contact::WallForce wall = contact::wallForce(pressing.law, touch.depth, closing_speed);
  Eigen::Map<Eigen::Vector3d>(contact.force) = wall.force * touch.normal;
  contact.stiffness = std::isfinite(wall.stiffness) ? wall.stiffness : stiffness_;
  stored_ += contact::wallEnergy(pressing.law, touch.depth);
  return touch.status;
}

const void* Pendulum::extension(const char* name) {
  if (std::string_view(name) != HSP_EXT_ENERGY) return tracedExtension<Pendulum>(name);
  energy_extension_ = {sizeof(hsp_ext_energy), 0, [](hsp_shape* shape) HSP_RT -> double {
                         const Pendulum& self = *reinterpret_cast<Pendulum*>(shape);
                         return self.body_->body().energy() + self.lifted_ + self.stored_;
                       }};
  return &energy_extension_;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::Pendulum)
