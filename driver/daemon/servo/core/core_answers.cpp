// SPDX-License-Identifier: MIT
/// What becomes of a shape's answer: it is judged, held to the plugin's claims, and kept in the world frame.
#include <algorithm>
#include <cmath>

#include "servo/core/core.hpp"

namespace hapticd::servo {

namespace {

using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

/// Also false for numbers whose squares overflow: a length of them would be none, and a ratio of two such.
bool finite(const double* values, size_t count) noexcept HSP_RT {
  constexpr double kLargest = 1e100;
  for (size_t i = 0; i < count; ++i)
    if (!(std::abs(values[i]) <= kLargest)) return false;
  return true;
}

bool finite(const hsp_contact& c) noexcept HSP_RT {
  return finite(c.force, 3) && finite(c.torque, 3) && ((c.flags & HSP_OUT_TRACED) == 0 || finite(c.point, 7));
}

}  // namespace

/// Whether the answers may be felt; a model that moves itself goes to its new pose.
Trouble Core::judge(ModelState& model, uint32_t index, double dt, const hsp_pose& pose) noexcept HSP_RT {
  bool answers_finite = true;
  for (const hsp_contact& out : outputs_) answers_finite &= finite(out);
  const bool moves_itself = (model.shape->report().flags & HSP_R_MOVES) != 0;
  Trouble trouble = Trouble::kNone;
  if (moves_itself && answers_finite) trouble = takePose(model, pose);
  if (uses_.exchange && model.moves && dt > 0) bookMotion(model, index);
  if (trouble != Trouble::kNotUnit)
    trouble = model.guard.judge(model.status, answers_finite && trouble == Trouble::kNone);
  else
    model.guard.enter(trouble);
  if (trouble == Trouble::kNone) trouble = holdToClaims(model, index, dt);
  if (trouble == Trouble::kBadStatus && model.failed_status == HSP_OK) model.failed_status = model.status;
  if (trouble == Trouble::kLost) {
    model.shape->reset();
    for (uint32_t i = 0; i < probe_count_; ++i) claims_[size_t{index} * probe_count_ + i].forget();
    wants_search_ = true;
  }
  return trouble;
}

/// The last good force, a part of it: what a model in trouble is still felt by.
void Core::fadeContact(uint32_t index, uint32_t probe, double part) noexcept HSP_RT {
  Contact& last = contacts_[size_t{index} * probe_count_ + probe];
  last.traced = false;
  Map(last.world.force) *= part;
  Map(last.world.torque) *= part;
}

/// What a healthy answer may still break: the time it was given, and what was claimed for it.
Trouble Core::holdToClaims(ModelState& model, uint32_t index, double dt) noexcept HSP_RT {
  constexpr int kJumps = 3;
  Trouble trouble = Trouble::kNone;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (model.moves) turn.noalias() = model.frame.R_world_model * model.before.R_world_model.transpose();
  for (uint32_t i = 0; i < probe_count_; ++i) {
    if (!holdToClaim(model, index, i, model.moves ? &turn : nullptr, dt)) continue;
    trouble = model.guard.strike(Trouble::kJump, kJumps);
  }
  if ((model.shape->report().flags & HSP_R_PUSHES) != 0)
    for (uint32_t i = 0; i < probe_count_; ++i) {
      if (!pullsIn(outputs_[i], model.frame.pointToModel(last_position_[i]))) continue;
      model.pull.depth = outputs_[i].depth_m;
      model.pull.force = ConstMap(outputs_[i].force).norm();
      return model.guard.enter(Trouble::kPulls);
    }
  return trouble == Trouble::kNone ? holdToTime(model) : trouble;
}

/// True if the force of the answer to this probe was beyond the claim: it is then what the claim explains.
bool Core::holdToClaim(ModelState& model, uint32_t index, uint32_t probe, const Eigen::Matrix3d* turn,
                       double dt) noexcept HSP_RT {
  hsp_contact& out = outputs_[probe];
  const hsp_probe& in = inputs_[probe];
  const Vector3d& p_world = last_position_[probe];
  ClaimStep step;
  step.force = model.frame.vectorToWorld(ConstMap(out.force));
  step.normal = model.frame.vectorToWorld(ConstMap(out.normal));
  step.p_world = p_world;
  step.p_model = model.claims.moves_itself ? model.frame.pointToModel(p_world) : Vector3d(ConstMap(in.position));
  step.velocity = ConstMap(in.velocity);
  step.origin = model.frame.origin_world;
  step.turn = turn;
  step.in = in.flags, step.out = out.flags;
  ClaimBounds bounds = model.claims;
  bounds.force = uses_.max_force[probe];
  bool held = false;
  const double asked = step.force.norm();
  const Vector3d let = claims_[size_t{index} * probe_count_ + probe].judge(step, bounds, dt, held);
  if (!held) return false;
  Map(out.force) = model.frame.vectorToModel(let);
  Map(out.torque) *= std::min(1.0, let.norm() / asked);
  return true;
}

/// The force of the last tick was held while the model's surface moved on: that work is the model's.
void Core::bookMotion(const ModelState& model, uint32_t index) noexcept HSP_RT {
  for (uint32_t i = 0; i < probe_count_; ++i) {
    const Contact& held = contacts_[size_t{index} * probe_count_ + i];
    const ConstMap force(held.world.force);
    if (force.isZero(0)) continue;
    const Vector3d from = held.traced ? Vector3d(ConstMap(held.world.point)) : last_position_[i];
    const Vector3d in_model = model.before.R_world_model.transpose() * (from - model.before.origin_world);
    const Vector3d to = model.frame.R_world_model * in_model + model.frame.origin_world;
    exchanges_[i].supplied += force.dot(to - from);
  }
}

/// A wall whose force grows with depth stores less than force times depth. What deforms says itself what it stores.
void Core::bookContact(const ModelState& model, const Contact& contact, uint32_t probe) noexcept HSP_RT {
  const ConstMap force(contact.world.force);
  if (force.isZero(0)) return;
  double recoverable = HUGE_VAL;
  const bool deforms = (model.shape->description().flags & HSP_C_DEFORMS) != 0;
  const double stored = model.shape->storedEnergy();
  if (contact.traced && (!deforms || model.shape->energy() != nullptr))
    recoverable = std::max(force.norm() * std::max(contact.world.depth_m, 0.0), stored);
  exchanges_[probe].recoverable += std::isfinite(recoverable) ? recoverable : HUGE_VAL;
}

Trouble Core::takePose(ModelState& model, hsp_pose pose) noexcept HSP_RT {
  constexpr double kUnit = 1e-3;  // as scenes may give them
  constexpr double kExact = 1e-12;
  if (!finite(pose.position, 13)) return Trouble::kNotFinite;
  Eigen::Map<Eigen::Vector4d> q(pose.orientation);
  const double length = q.norm();
  if (!(std::abs(length - 1) <= kUnit)) return Trouble::kNotUnit;
  if (std::abs(length - 1) > kExact) q /= length;
  model.pose = pose;
  model.frame = Frame::of(pose);
  return Trouble::kNone;
}

void Core::takeContact(ModelState& model, uint32_t index, uint32_t probe, double gain) noexcept HSP_RT {
  const hsp_contact& out = outputs_[probe];
  Contact& contact = contacts_[size_t{index} * probe_count_ + probe];
  contact.world = out;
  contact.traced = (out.flags & HSP_OUT_TRACED) != 0;
  if (model.level > 0 && std::isfinite(out.residual_m))
    model.degraded_residual = std::max(model.degraded_residual, out.residual_m);
  const Frame& frame = model.frame;
  Map(contact.world.force) = gain * frame.vectorToWorld(ConstMap(out.force));
  Map(contact.world.torque).setZero();
  if (uses_.torque) Map(contact.world.torque) = gain * frame.vectorToWorld(ConstMap(out.torque));
  if (!contact.traced) return;
  Map(contact.world.point) = frame.pointToWorld(ConstMap(out.point));
  Map(contact.world.normal) = frame.vectorToWorld(ConstMap(out.normal));
  if (!frame.identity) transforms_ += 2;
}

void Core::clearContacts(uint32_t index) noexcept HSP_RT {
  for (uint32_t i = 0; i < probe_count_; ++i) {
    contacts_[size_t{index} * probe_count_ + i] = Contact{};
    claims_[size_t{index} * probe_count_ + i].forget();
  }
}

}  // namespace hapticd::servo
