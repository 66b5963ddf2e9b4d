// SPDX-License-Identifier: MIT
#include "push_button.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace hapticd {
namespace {

// least component of the normal along the axis, of either sign: on steeper flanks a push hardly moves the button
constexpr double kSteepest = 0.1;

// [s] Without a sample a finger presses on as it did for kBlind. Then its press fades, else another finger would bear
// the whole detent at once. After kGone, when the host counts the arm as lost, it presses nothing. Once it has samples
// again, its press comes back as slowly.
constexpr double kBlind = 0.025, kGone = 0.05;

/// Returns the flags (HSP_OUT_*) of a step of the button. @param button the button after the step
uint32_t clickOf(const dynamics::ButtonState& button, const dynamics::ButtonState::Step& step) noexcept HSP_RT {
  if (!step.clicked) return 0;
  return HSP_OUT_EVENT | (button.pressed() ? HSP_OUT_WENT_IN : HSP_OUT_CAME_OUT);
}

}  // namespace

void PushButton::activate(const hsp_activation& activation, hsp_report& report) {
  load(activation, report);
  inward_ = Eigen::Vector3d(axis_.data());
  if (!(inward_.norm() > 0))
    throw std::invalid_argument("axis: [0, 0, 0] has no direction; give one such as [0, -1, 0]");
  inward_.normalize();
  std::vector<dynamics::DetentCurve::Knot> knots;
  for (size_t i = 0; i + 1 < detent_.size(); i += 2) knots.push_back({detent_[i], detent_[i + 1]});
  curve_.emplace(knots, end_stiffness_);
  rest_ = Eigen::Vector3d(activation.pose.position);
  const double* q = activation.pose.orientation;
  turn_ = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  button_.reset();
  last_x2_ = stored_ = 0;
  fingers_.assign(std::max(activation.max_probes, 1u), Finger{});
  probes_.emplace(std::max(activation.max_probes, 1u));
  presses_.reserve(std::max(activation.max_probes, 1u));
  report.max_stiffness = stiffness_;
  letGoBeyond(forceToClaimFor(activation, kUnknownForce) / stiffness_);
  report.flags |= HSP_R_MOVES | HSP_R_PUSHES;
  // greatest force of the detent: where the detent falls faster than the surface's spring, the button snaps, and the
  // force jumps by less than this
  double highest = 0;
  for (const dynamics::DetentCurve::Knot& knot : knots) highest = std::max(highest, knot.force);
  reportJumps(report, highest);
}

void PushButton::reset() noexcept HSP_RT {
  TracedShape::reset();
  button_.reset();
  stored_ = 0;
  std::fill(fingers_.begin(), fingers_.end(), Finger{});
}

/// Lists the probes that may press, measured on the cap at each probe. If the cap's normal is tilted, its stiffness
/// counts with the square of the normal's component along the axis.
void PushButton::listPresses(const hsp_step& step) noexcept HSP_RT {
  presses_.clear();
  for (uint32_t i = 0; i < step.count; ++i) {
    const hsp_probe& probe = *HSP_AT(const hsp_probe, step.in, step.in_stride, i);
    Finger& finger = fingers_[i];
    hsp_contact unused{};
    const Touch touch = trace(probe, step, unused);
    const bool blind = (probe.flags & HSP_IN_INVALID) != 0;
    finger.blind_for = blind ? finger.blind_for + step.dt_s : 0;
    if (!blind) finger.press = pressOf(touch);
    const double change = step.dt_s / (kGone - kBlind);
    finger.share = std::clamp(finger.share + (finger.blind_for > kBlind ? -change : change), 0.0, 1.0);
    dynamics::ButtonPress press = finger.press;
    press.stiffness *= finger.share;
    if (press.stiffness > 0) presses_.push_back(press);
  }
}

/// Returns the press of a probe; without stiffness if the probe cannot move the button.
dynamics::ButtonPress PushButton::pressOf(const Touch& touch) const noexcept HSP_RT {
  const double along = -touch.normal.dot(inward_);
  if (!touch.traced || std::abs(along) < kSteepest) return {};
  return {stiffness_ * along * along, button_.position() + touch.depth / along, along < 0};
}

/// The button has no mass, so in every tick it is where the springs balance. First the probes are traced on the cap of
/// the last tick; then the balance moves the cap, and the probes are traced again.
hsp_status PushButton::step(const hsp_step& step) noexcept HSP_RT {
  uint32_t clicked = 0;  // HSP_OUT_* of a click in this step
  const MovingFrame before = MovingFrame::of(*step.pose);
  if (step.dt_s > 0) {
    listPresses(step);
    clicked = clickOf(button_, button_.step(presses_, *curve_));
  }
  const MovingFrame now = frame(step.dt_s);
  now.write(*step.pose);
  const hsp_step moved = probes_->step(step, before, now);
  stored_ = curve_->energy(button_.position());
  return touchEach(moved, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t) {
    const Touch touch = trace(probe, moved, contact);
    contact.flags |= clicked;
    if (!touch.traced || touch.depth <= 0) return touch.status;
    Eigen::Map<Eigen::Vector3d>(contact.force) = stiffness_ * touch.depth * touch.normal;
    contact.stiffness = stiffness_;
    stored_ += stiffness_ * touch.depth * touch.depth / 2;
    return touch.status;
  });
}

MovingFrame PushButton::frame(double dt) noexcept HSP_RT {
  const Eigen::Vector3d inward_world = turn_ * inward_;
  const double x2 = button_.position();
  MovingFrame now{rest_ + x2 * inward_world, turn_, {0, 0, 0}, {0, 0, 0}};
  if (dt > 0) now.linear = (x2 - last_x2_) / dt * inward_world;
  last_x2_ = x2;
  return now;
}

const void* PushButton::extension(const char* name) {
  if (std::string_view(name) != HSP_EXT_ENERGY) return tracedExtension<PushButton>(name);
  energy_extension_ = {sizeof(hsp_ext_energy), 0,
                       [](hsp_shape* shape) HSP_RT -> double { return reinterpret_cast<PushButton*>(shape)->stored_; }};
  return &energy_extension_;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::PushButton)
