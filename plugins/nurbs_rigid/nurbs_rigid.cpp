// SPDX-License-Identifier: MIT
#include "nurbs_rigid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace hapticd {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

void NurbsRigid::activate(const hsp_activation& activation, hsp_report& report) {
  if (friction_dynamic_ > friction_static_)
    throw std::invalid_argument("friction_dynamic: " + number(friction_dynamic_) + " is more than friction_static, " +
                                number(friction_static_) + "; it must not be greater");
  if (motion_ != kDynamic && !limits_.empty())
    throw std::invalid_argument(
        std::string("limits: end stops hold only a body that moves under forces, and this model is motion: ") +
        kMotionNames[motion_] + "; set motion: dynamic, or remove limits");
  if (tip_radius_ > 0 && pop_through_ > 0)
    throw std::invalid_argument(
        "tip_radius: a shell does not give way to a ball, only to a point; remove tip_radius or pop_through");
  takeParts(instance_name_, left_out_);
  load(activation, report);
  if (pop_through_ > 0 && sides_ != kBoth)
    writeLog(HSP_LOG_WARNING, "pop_through: has no effect, because only a shell gives way; set sides: both");
  extents_ = part() != nullptr ? extentsOf(*part()) : extentsOf(model());
  if (extents_.empty() && texture_amplitude_ > 0)
    throw std::invalid_argument(
        "texture.amplitude: a mesh has no parameters u and v, so it cannot have bumps; expected 0, or a geometry of "
        "surfaces (a CAD part or a model file)");
  double slope = 0;
  for (const Extent& extent : extents_) slope = std::max(slope, slopeOf(extent));
  if (slope > kSteepest)
    throw std::invalid_argument("texture.amplitude: bumps of " + number(texture_amplitude_) + " m rise " +
                                number(slope) + " m per m at this texture.wavelength; the slope must be " +
                                number(kSteepest) + " or less, so give at most " +
                                number(texture_amplitude_ * kSteepest / slope) + " m");
  const contact::WallLaw law{stiffness_, damping_, exponent_, depth_scale_};
  const double force = forceToClaimFor(activation, kUnknownForce);
  const double steepest = stiffness_ > 0 ? contact::wallSlopeAt(law, force) : 0;
  report.max_stiffness = steepest * (1 + slope);
  letGoBeyond(contact::wallDepthAt(law, force));
  if (part() != nullptr && sides_ == kFront) warnOfThinWalls(activation);
  if (pop_through_ > 0 && sides_ == kBoth) reportJumps(report, pop_through_);
  if (damping_ > 0 || viscosity_ > 0) report.flags |= HSP_R_VELOCITY;
  const bool rubs = friction_static_ > 0 || viscosity_ > 0;
  if (!rubs) report.flags |= HSP_R_PUSHES;
  friction_.assign(rubs ? std::max(activation.max_probes, 1u) : 0, contact::Friction{});
  body_.reset();
  if (motion_ == kDynamic) setInMotion(activation, report);
}

void NurbsRigid::setInMotion(const hsp_activation& activation, hsp_report& report) {
  bool bounded = true;
  const dynamics::MassProperties shape =
      part() != nullptr ? massProperties(*part(), bounded) : massProperties(model(), bounded);
  const bool asked = center_.empty() || inertia_.empty();
  if (!bounded && asked)
    writeLog(HSP_LOG_WARNING,
             "the surfaces are not closed, so center or inertia, if not given, are taken from the box around them");
  body_.emplace(lawOf(*this, shape), MovingFrame::of(activation.pose),
                gravity_ ? Eigen::Vector3d(activation.gravity) : Eigen::Vector3d::Zero(), activation);
  body_->setVelocity(Eigen::Vector3d(velocity_.data()), Eigen::Vector3d(spin_.data()));
  if (joint_ == static_cast<int>(dynamics::Joint::kHinge) && part() != nullptr) warnOfCrossedAxis();
  if (joint_ != static_cast<int>(dynamics::Joint::kFree)) writeLog(HSP_LOG_DEBUG, jointText(*this, body_->body()));
  report.flags |= HSP_R_MOVES;
}

void NurbsRigid::reset() noexcept HSP_RT {
  TracedShape::reset();
  for (contact::Friction& friction : friction_) friction.reset();
  if (body_) body_->release();
  stored_ = 0;
}

hsp_status NurbsRigid::step(const hsp_step& given) noexcept HSP_RT {
  const hsp_step step = body_ ? body_->move(given) : given;
  const uint32_t end = body_ ? body_->endFlags() : 0;
  stored_ = 0;
  return touchEach(step, [&](const hsp_probe& probe, hsp_contact& contact, uint32_t) {
    const hsp_status status = press(probe, step, contact);
    contact.flags |= end;
    return status;
  });
}

hsp_status NurbsRigid::press(const hsp_probe& probe, const hsp_step& step, hsp_contact& contact) noexcept HSP_RT {
  const Touch touch = trace(probe, step, contact);
  const uint32_t index = indexOf(probe, step);
  // a stuck point from before a jump would pull the probe toward where it was
  if (index < friction_.size() && (probe.flags & HSP_IN_JUMP) != 0) friction_[index].reset();
  const double depth = touch.depth + (touch.traced && texture_amplitude_ > 0 ? texture(touch.foot) : 0);
  if (!touch.traced || touch.depth <= 0 || depth <= 0) {
    if (index < friction_.size()) friction_[index].reset();
    if (body_ && touch.traced) remember(probe, touch, index, depth, Eigen::Vector3d::Zero());
    return touch.status;
  }
  const Eigen::Vector3d velocity(probe.velocity);
  const contact::WallLaw law{stiffness_, damping_, exponent_, depth_scale_};
  const contact::WallForce wall = contact::wallForce(law, depth, -velocity.dot(touch.normal));
  Eigen::Vector3d rub = Eigen::Vector3d::Zero();
  if (index < friction_.size()) {
    const contact::FrictionLaw friction{friction_static_, friction_dynamic_, stiffness_, viscosity_};
    rub = friction_[index].step(friction, touch.foot.point, touch.normal, wall.force, velocity);
    stored_ += friction_[index].energy(friction);
  }
  Eigen::Map<Eigen::Vector3d>(contact.force) = wall.force * touch.normal + rub;
  contact.stiffness = std::isfinite(wall.stiffness) ? wall.stiffness : stiffness_;
  stored_ += contact::wallEnergy(law, depth);
  if (body_) remember(probe, touch, index, depth, rub);
  if (pop_through_ > 0 && wall.force > pop_through_) popThrough(index);
  return touch.status;
}

/// Stores the contact of this step, which pushes a dynamic body in the next step. A probe just outside is stored too,
/// because it may touch the body by then.
void NurbsRigid::remember(const hsp_probe& probe, const Touch& touch, uint32_t index, double depth,
                          const Eigen::Vector3d& rub) noexcept HSP_RT {
  dynamics::LastContact pressing;
  pressing.probe = Eigen::Vector3d(probe.position);
  pressing.point = touch.foot.point;
  pressing.normal = touch.normal;
  pressing.depth = depth;
  pressing.law = {stiffness_, damping_, exponent_, depth_scale_};
  pressing.along = rub;
  if (index < friction_.size() && depth > 0) {
    const double most = friction_static_ * contact::wallForce(pressing.law, depth, 0).force;
    pressing.along_limit = friction_[index].slipping() ? rub.norm() : std::max(rub.norm(), most);
    pressing.along_stiffness = most > 0 ? stiffness_ : 0;
    pressing.along_damping = viscosity_;
  }
  if (body_) body_->remember(index, pressing);
}

std::vector<NurbsRigid::Extent> NurbsRigid::extentsOf(const trace::Model& model) {
  constexpr int kSamples = 16;
  std::vector<Extent> extents;
  spline::SurfacePoint E;
  for (int surface = 0; surface < model.surfaceCount(); ++surface) {
    Extent extent{{0, 0}, {1, 1}, {1, 1}};
    const int first = model.firstPatch(surface), last = model.lastPatch(surface);
    if (first == last) {  // a surface without area is never touched
      extents.push_back(extent);
      continue;
    }
    extent.lo = model.patch(first).lo;
    Eigen::Array2d hi = model.patch(first).hi;
    for (int i = first; i < last; ++i) {
      extent.lo = extent.lo.min(model.patch(i).lo);
      hi = hi.max(model.patch(i).hi);
    }
    extent.range = hi - extent.lo;
    extent.length.setZero();
    for (int i = first; i < last; ++i) {
      const trace::Patch& patch = model.patch(i);
      const double share = ((patch.hi - patch.lo) / extent.range).prod() / (kSamples * kSamples);
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const int row = k / kSamples, column = k % kSamples;
        const Eigen::Array2d middle(row + 0.5, column + 0.5);
        const Eigen::Array2d uv = patch.lo + (patch.hi - patch.lo) * middle / kSamples;
        patch.surface.evaluate1(uv[0], uv[1], E);
        extent.length += share * extent.range * Eigen::Array2d(E.Su.norm(), E.Sv.norm());
      }
    }
    extents.push_back(extent);
  }
  return extents;
}

/// Returns the height [m] of the bumps at a foot: the product of waves along u and v. Each surface has a whole number
/// of waves, so the height is 0 on all its sides, and does not jump at seams, common edges and poles.
double NurbsRigid::texture(const trace::Foot& foot) const noexcept HSP_RT {
  if (extents_.empty()) return 0;
  const Extent& extent = extents_[static_cast<std::size_t>(foot.surface)];
  const double steep = slopeOf(extent) / kSteepest;  // above 1 only if the parameter was changed during the run
  const Eigen::Array2d phase =
      2 * std::numbers::pi * wavesOf(extent) * (Eigen::Array2d(foot.u, foot.v) - extent.lo) / extent.range;
  return texture_amplitude_ / std::max(1.0, steep) * std::sin(phase[0]) * std::sin(phase[1]);
}

const void* NurbsRigid::extension(const char* name) {
  if (std::string_view(name) != HSP_EXT_ENERGY) return tracedExtension<NurbsRigid>(name);
  energy_extension_ = {sizeof(hsp_ext_energy), 0, [](hsp_shape* shape) HSP_RT -> double {
                         const NurbsRigid& self = *reinterpret_cast<NurbsRigid*>(shape);
                         return self.stored_ + (self.body_ ? self.body_->body().energy() : 0);
                       }};
  return &energy_extension_;
}

}  // namespace hapticd

HAPTICD_SHAPES(hapticd::NurbsRigid)
