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

void Pendulum::activate(const hsp_activation& activation, hsp_report& report) {
  load(activation, report);
  const Eigen::Vector3d axis(axis_.data());
  if (!(axis.norm() > 0)) throw std::invalid_argument("axis: [0, 0, 0] has no direction; give one such as [0, 0, 1]");
  drawn_ = MovingFrame::of(activation.pose);
  axis_world_ = drawn_.orientation * axis.normalized();
  pivot_world_ = drawn_.position + drawn_.orientation * Eigen::Vector3d(pivot_.data());
  const Eigen::Vector3d gravity(activation.gravity);
  const double inertia = inertia_ > 0 ? inertia_ : mass_ * length_ * length_;
  law_ = {mass_, inertia, length_, damping_, (gravity - gravity.dot(axis_world_) * axis_world_).norm()};
  if (!(inertia > 0))
    throw std::invalid_argument(
        "pendulum: inertia: a point mass at length 0 has no inertia; give an inertia or a length above 0");
  dynamics::validate(law_);
  dynamics::validateSwing(std::sqrt(law_.frequencySquared()), activation.rate_hz);
  checkFelt(std::sqrt(law_.frequencySquared()), activation.rate_hz);
  state_ = {angle_, rate_};
  stored_ = 0;
  probes_.emplace(std::max(activation.max_probes, 1u));
  presses_.emplace(std::max(activation.max_probes, 1u));
  const contact::WallLaw wall{stiffness_, contact_damping_, exponent_, depth_scale_};
  report.max_stiffness = stiffness_ > 0 ? contact::wallSlopeAt(wall, forceToClaimFor(activation, kUnknownForce)) : 0;
  report.flags |= HSP_R_MOVES | HSP_R_PUSHES;
  if (contact_damping_ > 0) report.flags |= HSP_R_VELOCITY;
}

void Pendulum::reset() noexcept HSP_RT {
  TracedShape::reset();
  if (presses_) presses_->release();
  stored_ = 0;
}

/// Computes the pose from the angle and the pose in the scene, not step by step. So after any number of ticks it has
/// only the error of the angle.
MovingFrame Pendulum::frame() const noexcept HSP_RT {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(std::remainder(state_.angle, 2 * M_PI), axis_world_));
  MovingFrame now;
  now.orientation = (turn * drawn_.orientation).normalized();
  now.position = pivot_world_ + turn * (drawn_.position - pivot_world_);
  now.angular = state_.rate * axis_world_;
  now.linear = now.angular.cross(now.position - pivot_world_);
  return now;
}

/// Makes a step under the forces of the hand by backward Euler: it uses the torques at the end of the step, so it is
/// stable even for a very light pendulum. A contact that lets go acts only if the pendulum comes after the probe.
/// @return false if no contact acts; then nothing was done
bool Pendulum::push(std::span<const dynamics::PredictedContact> presses, double dt) noexcept HSP_RT {
  const double weight = law_.mass * law_.gravity * law_.length, here = state_.angle + dt * state_.rate;
  const double own = law_.inertia + dt * (law_.damping + dt * weight * std::max(0.0, std::cos(state_.angle)));
  const double own_impulse = -dt * (weight * std::sin(here) + law_.damping * state_.rate);
  // velocity of the point per angular velocity
  const auto moment_of = [this](const dynamics::PredictedContact& press) -> Eigen::Vector3d {
    return axis_world_.cross(press.point - pivot_world_);
  };
  const auto change_under = [&](const auto& acts) {
    double resisting = own, impulse = own_impulse;
    for (const dynamics::PredictedContact& press : presses) {
      if (!acts(press)) continue;
      const Eigen::Vector3d moment = moment_of(press);
      resisting += dt * moment.dot(press.give * moment);
      impulse += dt * moment.dot(press.force);
    }
    return impulse / resisting;
  };
  const double first = change_under([](const dynamics::PredictedContact& press) { return !press.lets_go; });
  const auto acts = [&](const dynamics::PredictedContact& press) {
    return !press.lets_go || !dynamics::forceAfter(press, first * moment_of(press)).isZero(0);
  };
  if (std::none_of(presses.begin(), presses.end(), acts)) return false;
  const double change = change_under(acts);
  double impulse = own_impulse;
  for (const dynamics::PredictedContact& press : presses) {
    if (!acts(press)) continue;
    const Eigen::Vector3d moment = moment_of(press);
    impulse += dt * moment.dot(dynamics::forceAfter(press, change * moment));
  }
  state_.rate += impulse / own;
  state_.angle += dt * state_.rate;
  return true;
}

hsp_status Pendulum::step(const hsp_step& step) noexcept HSP_RT {
  const MovingFrame before = MovingFrame::of(*step.pose);
  const auto velocity_at = [this](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return state_.rate * axis_world_.cross(point - pivot_world_);
  };
  if (step.dt_s > 0) {
    const auto presses = presses_->predict(step, before, velocity_at);
    if (presses.empty() || !push(presses, step.dt_s)) state_ = dynamics::advance(law_, state_, 0, step.dt_s);
    // keeps the precision of the angle if the pendulum goes round many times
    state_.angle = std::remainder(state_.angle, 2 * M_PI);
  }
  const MovingFrame now = frame();
  now.write(*step.pose);
  const hsp_step moved = probes_->step(step, before, now);
  hsp_status worst = HSP_OK;
  stored_ = 0;
  for (uint32_t i = 0; i < moved.count; ++i) {
    const hsp_status status = press(*HSP_AT(const hsp_probe, moved.in, moved.in_stride, i), moved,
                                    *HSP_AT(hsp_contact, step.out, step.out_stride, i), now);
    if (status < 0 ? worst >= 0 : worst == HSP_OK) worst = status;
  }
  return worst;
}

hsp_status Pendulum::press(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact,
                           const MovingFrame& now) noexcept HSP_RT {
  const Touch touch = trace(probe, step, contact);
  if (!touch.traced) return touch.status;
  dynamics::LastContact pressing;
  pressing.probe = Eigen::Vector3d(probe.position);
  pressing.point = touch.foot.point;
  pressing.normal = touch.normal;
  pressing.depth = touch.depth;
  pressing.law = {stiffness_, contact_damping_, exponent_, depth_scale_};
  presses_->remember(indexOf(probe, step), pressing, now);
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
                         return dynamics::energy(self.law_, self.state_) + self.stored_;
                       }};
  return &energy_extension_;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::Pendulum)
