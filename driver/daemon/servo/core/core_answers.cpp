// SPDX-License-Identifier: MIT
/// Checks the answer of a shape, reduces it to the plugin's claims, and stores it in the world frame.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "servo/core/core.hpp"

namespace hapticd::servo {

namespace {

using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

constexpr double kLargest = 1e100;

/// False also for finite numbers whose squares overflow, because no length can be calculated from them.
bool finite(const double* values, size_t count) noexcept HSP_RT {
  for (size_t i = 0; i < count; ++i)
    if (!(std::abs(values[i]) <= kLargest)) return false;
  return true;
}

/// Groups of adjacent numbers in an answer: Wrench is force and torque; Foot is foot point, normal and depth.
using Wrench = Eigen::Map<const Eigen::Matrix<double, 6, 1>>;
using Foot = Eigen::Map<const Eigen::Matrix<double, 7, 1>>;
static_assert(offsetof(hsp_contact, torque) == offsetof(hsp_contact, force) + 3 * sizeof(double));
static_assert(offsetof(hsp_contact, depth_m) == offsetof(hsp_contact, point) + 6 * sizeof(double));

/// Fast check, because it runs for every answer in every tick: if the sum of the squares is small, so is each number.
bool finite(const hsp_contact& c) noexcept HSP_RT {
  const bool traced = (c.flags & HSP_OUT_TRACED) != 0;
  const double squares = Wrench(c.force).squaredNorm() + (traced ? Foot(c.point).squaredNorm() : 0);
  if (squares <= kLargest) return true;
  return finite(c.force, 3) && finite(c.torque, 3) && (!traced || finite(c.point, 7));
}

}  // namespace

/// Reduces the torque of the answer to this probe to what the claim allows, and returns true if it was larger. Call it
/// before the force is judged, because judging the force stores the place of the probe.
bool Core::holdTorque(const ModelState& model, Claim& claim, uint32_t probe, double dt) noexcept HSP_RT {
  ClaimStep& step = claim_step_;
  hsp_contact& out = outputs_[probe];
  const bool reads = (model.shape->report().flags & HSP_R_ORIENTATION) != 0;
  step.torque = model.frame.vectorToWorld(ConstMap(out.torque));
  step.max_torque = uses_.max_torque[probe];
  step.orientation = Eigen::Vector4d::UnitW();
  if (reads) step.orientation = last_orientation_[probe].coeffs();
  bool held = false;
  const Vector3d let = claim.checkTorque(step, model.claims, dt, held);
  if (held) Map(out.torque) = model.frame.vectorToModel(let);
  return held;
}

namespace {

/// Keeps in model.breach the largest jump of force so far, as the max_jump that the plugin would have to claim so that
/// this jump is allowed. The time of the jump (breach.t) is filled in after the step.
void noteJump(ModelState& model, const ClaimStep& step, const Vector3d& let, const hsp_contact& out) noexcept HSP_RT {
  const double size = step.force.norm();
  const double felt = step.max_force > 0 && size > step.max_force ? step.max_force / size : 1;
  const double jump = std::max(Claim::kStep, model.claims.jump) + (felt * step.force - let).norm();
  if (jump <= model.breach.force) return;
  const bool inside = (out.flags & HSP_OUT_TRACED) != 0 && out.depth_m >= 0;
  model.breach = Breach{-1, inside ? out.depth_m : -1, jump};
}

/// Returns where the motion of a model in this step has carried a place of it, in the world frame.
Vector3d carried(const ModelState& model, const Vector3d& from) noexcept HSP_RT {
  const Vector3d in_model = model.before.R_world_model.transpose() * (from - model.before.origin_world);
  return model.frame.R_world_model * in_model + model.frame.origin_world;
}

}  // namespace

/// Reduces force and torque of the answer to this probe to what the claim allows, and returns which of them was larger.
/// This function and its caller are inlined into checkAnswer(): they run for every answer in every tick, and a call
/// costs as much as they do.
[[gnu::always_inline]] inline ShapeFault Core::holdToClaim(ModelState& model, uint32_t index, uint32_t probe,
                                                           double dt) noexcept HSP_RT {
  hsp_contact& out = outputs_[probe];
  const hsp_probe& in = inputs_[probe];
  ClaimStep& step = claim_step_;
  step.force = model.frame.vectorToWorld(ConstMap(out.force));
  step.p_model = ConstMap(in.position);
  step.velocity = ConstMap(in.velocity);
  step.in = in.flags, step.out = out.flags;
  step.max_force = uses_.max_force[probe];
  if ((out.flags & HSP_OUT_TRACED) != 0) step.normal = model.frame.vectorToWorld(ConstMap(out.normal));
  step.turn = model.moves ? &turn_ : nullptr;
  if (model.claims.moves_itself) {  // inputs_ are relative to the pose before this step
    step.p_world = last_position_[probe];
    step.p_model = model.frame.pointToModel(step.p_world);
    step.origin = model.frame.origin_world;
  }
  Claim& claim = claims_[at(index, probe)];
  const bool twists = uses_.torque && !settings_.former_claims && holdTorque(model, claim, probe, dt);
  bool held = false;
  const Vector3d let = claim.check(step, model.claims, dt, held);
  if (!held && !twists) return ShapeFault::kNone;
  if (held) {
    if (!claim.excused()) noteJump(model, step, let, out);
    Map(out.force) = model.frame.vectorToModel(let);
    Map(out.torque) *= std::min(1.0, let.norm() / step.force.norm());
  }
  return claim.excused() ? ShapeFault::kNone : held ? ShapeFault::kJump : ShapeFault::kTwists;
}

/// Checks an answer without other errors against the time for a step and the claims of the shape.
[[gnu::always_inline]] inline ShapeFault Core::holdToClaims(ModelState& model, uint32_t index,
                                                            double dt) noexcept HSP_RT {
  constexpr int kJumps = 3;
  ShapeFault fault = ShapeFault::kNone;
  if (model.moves) turn_.noalias() = model.frame.R_world_model * model.before.R_world_model.transpose();
  for (uint32_t i = 0; i < probe_count_; ++i) {
    const ShapeFault beyond = holdToClaim(model, index, i, dt);
    if (beyond != ShapeFault::kNone) fault = model.guard.strike(beyond, kJumps);
  }
  if ((model.shape->report().flags & HSP_R_PUSHES) != 0 && pulls(model)) return model.guard.enter(ShapeFault::kPulls);
  if (gives(model, index, dt)) return model.guard.enter(ShapeFault::kGives);
  return fault == ShapeFault::kNone ? holdToTime(model) : fault;
}

/// Decides whether the answers of a model may be felt. A model that moves itself takes its new pose.
ShapeFault Core::checkAnswer(ModelState& model, uint32_t index, double dt, const hsp_pose& pose) noexcept HSP_RT {
  bool answers_finite = true;
  for (const hsp_contact& out : outputs_) answers_finite &= finite(out);
  const bool moves_itself = (model.shape->report().flags & HSP_R_MOVES) != 0;
  ShapeFault fault = ShapeFault::kNone;
  if (moves_itself && answers_finite) fault = takePose(model, pose);
  if (uses_.exchange && model.moves && dt > 0) recordMotion(model, index);
  if (fault != ShapeFault::kNotUnit)
    fault = model.guard.check(model.status, answers_finite && fault == ShapeFault::kNone);
  else
    model.guard.enter(fault);
  if (fault == ShapeFault::kNone) fault = holdToClaims(model, index, dt);
  constexpr int kTooFast = 3;
  if (fault == ShapeFault::kNone && moves_itself && runsAway(model, index, dt))
    fault = model.guard.strike(ShapeFault::kRunsAway, kTooFast);
  if (fault == ShapeFault::kBadStatus && model.failed_status == HSP_OK) model.failed_status = model.status;
  if (fault == ShapeFault::kLost) {
    model.shape->reset();
    for (uint32_t i = 0; i < probe_count_; ++i) claims_[at(index, i)].forget();
    needs_search_ = true;
  }
  return fault;
}

/// Replaces the answer by a part of the last good force, to fade out a faulty model.
void Core::fadeContact(uint32_t index, uint32_t probe, double part) noexcept HSP_RT {
  Contact& last = contacts_[at(index, probe)];
  last.traced = false;
  Map(last.world.force) *= part;
  Map(last.world.torque) *= part;
}

/// Returns true, and notes the pull, if one of the answers pulls the probe in.
bool Core::pulls(ModelState& model) noexcept HSP_RT {
  for (uint32_t i = 0; i < probe_count_; ++i) {
    if (!pullsIn(outputs_[i], model.frame.pointToModel(last_position_[i]))) continue;
    model.breach = Breach{-1, outputs_[i].depth_m, ConstMap(outputs_[i].force).norm()};
    return true;
  }
  return false;
}

/// Returns true if a model gave energy from nowhere. Only a hard surface is held to what was put in: what is soft gives
/// back what it stored at another place, a shape that reports jumps gives energy on purpose, and a force without a
/// contact may be a push or a magnet. What nobody feels, because the model is disabled or came around a tip, gives
/// none.
bool Core::gives(ModelState& model, uint32_t index, double dt) noexcept HSP_RT {
  const bool rests = (model.shape->description().flags & HSP_C_DEFORMS) == 0 && !(model.claims.jump > 0);
  const double reported = model.shape->storedEnergy();
  bool too_much = false;
  for (uint32_t i = 0; i < probe_count_; ++i) {
    const hsp_probe& in = inputs_[i];
    const hsp_contact& out = outputs_[i];
    EnergyAccount& account = energies_[at(index, i)];
    const bool felt = model.guard.gain() > 0 && (in.flags & HSP_IN_INVALID) == 0;
    if (!felt || (in.flags & HSP_IN_JUMP) != 0) account.forgetPush();
    if (!felt) continue;
    const bool touches = (out.flags & HSP_OUT_TRACED) != 0 && out.depth_m > 0;
    Push push{ConstMap(out.force), ConstMap(in.position), touches ? out.depth_m : 0, touches && rests};
    if (model.claims.moves_itself) push.position = model.frame.pointToModel(last_position_[i]);
    const double most = uses_.max_force[i], square = push.force.squaredNorm();
    if (most > 0 && square > most * most) push.force *= most / std::sqrt(square);
    too_much |= account.step(push, dt, reported, most);
  }
  return too_much;
}

/// Returns the place of a model on which its force of the last tick acts.
Vector3d Core::touchedPlace(uint32_t index, uint32_t probe) const noexcept HSP_RT {
  const Contact& held = contact(index, probe);
  return held.traced ? Vector3d(ConstMap(held.world.point)) : last_position_[probe];
}

/// Returns the direction in which the last force of a model pushes the probe: that of the surface, without friction.
Vector3d Core::pushDirection(uint32_t index, uint32_t probe) const noexcept HSP_RT {
  const Contact& held = contact(index, probe);
  const ConstMap force(held.world.force), normal(held.world.normal);
  if (!held.traced) return force.normalized();
  return force.dot(normal) < 0 ? -normal : Vector3d(normal);
}

/// Returns true if a place that pushes comes against the probe faster than the fastest tip. A body whose force has the
/// wrong sign, or whose spring is too stiff for its integrator, becomes ever faster, and would push with all that the
/// arm may. A body that goes away, or turns past the probe as a wheel does, is no danger at any speed.
bool Core::runsAway(const ModelState& model, uint32_t index, double dt) const noexcept HSP_RT {
  if (!(dt > 0)) return false;
  for (uint32_t i = 0; i < probe_count_; ++i) {
    if (ConstMap(contact(index, i).world.force).isZero(0)) continue;
    const Vector3d from = touchedPlace(index, i);
    if ((carried(model, from) - from).dot(pushDirection(index, i)) > settings_.max_probe_speed * dt) return true;
  }
  return false;
}

/// Adds the work that a moving model did on the probe: the force of the last tick times the motion of the surface since
/// then.
void Core::recordMotion(const ModelState& model, uint32_t index) noexcept HSP_RT {
  for (uint32_t i = 0; i < probe_count_; ++i) {
    const ConstMap force(contact(index, i).world.force);
    if (force.isZero(0)) continue;
    const Vector3d from = touchedPlace(index, i);
    exchanges_[i].supplied += force.dot(carried(model, from) - from);
  }
}

/// Adds the energy that a contact can give back: at most force times depth, for any wall whose force grows with depth.
/// A soft shape reports its energy itself.
void Core::recordContact(const ModelState& model, const Contact& contact, uint32_t probe) noexcept HSP_RT {
  const ConstMap force(contact.world.force);
  if (force.isZero(0)) return;
  double recoverable = HUGE_VAL;
  const bool deforms = (model.shape->description().flags & HSP_C_DEFORMS) != 0;
  const double stored = model.shape->storedEnergy();
  if (contact.traced && (!deforms || model.shape->energy() != nullptr))
    recoverable = std::max(force.norm() * std::max(contact.world.depth_m, 0.0), stored);
  exchanges_[probe].recoverable += std::isfinite(recoverable) ? recoverable : HUGE_VAL;
}

ShapeFault Core::takePose(ModelState& model, hsp_pose pose) noexcept HSP_RT {
  constexpr double kUnit = 1e-3;  // the same tolerance as for quaternions in scenes
  constexpr double kExact = 1e-12;
  if (!finite(pose.position, 13)) return ShapeFault::kNotFinite;
  Eigen::Map<Eigen::Vector4d> q(pose.orientation);
  const double length = q.norm();
  if (!(std::abs(length - 1) <= kUnit)) return ShapeFault::kNotUnit;
  if (std::abs(length - 1) > kExact) q /= length;
  model.pose = pose;
  model.frame = Frame::of(pose);
  return ShapeFault::kNone;
}

void Core::takeContact(ModelState& model, uint32_t index, uint32_t probe, double gain) noexcept HSP_RT {
  const hsp_contact& out = outputs_[probe];
  Contact& contact = contacts_[at(index, probe)];
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

/// Decides whether a model that was added or enabled may be felt. It is not felt while a tip is inside, because its
/// whole force would reach the hand at once. A model that pushes without a surface has no outside, so it fades in
/// slowly. The model must have been free for kFreeFor, because before the first search every model seems to be free.
/// @param pace [s] of the fade in this tick; made smaller for a slow fade
bool Core::enters(ModelState& model, std::span<const Probe> probes, double& pace) const noexcept HSP_RT {
  bool asked = false, pushes = false;
  for (uint32_t i = 0; i < probe_count_; ++i) {
    if (!probes[i].valid) continue;
    const hsp_contact& out = outputs_[i];
    if ((out.flags & HSP_OUT_TRACED) != 0 && out.depth_m > 0) {
      model.free_for = 0;
      model.waits = true;
      return false;
    }
    asked = true;
    pushes |= !ConstMap(out.force).isZero(0) || !ConstMap(out.torque).isZero(0);
  }
  if (!asked) return false;
  model.free_for += pace;
  if (model.free_for < kFreeFor) return false;
  model.waits = false;
  if (pushes) pace *= Guard::kFadeIn / Guard::kFadeInOfField;
  model.until_free = pushes && model.guard.gain() < 1;
  return true;
}

void Core::clearContacts(uint32_t index) noexcept HSP_RT {
  for (uint32_t i = 0; i < probe_count_; ++i) {
    contacts_[at(index, i)] = Contact{};
    claims_[at(index, i)].forget();
    energies_[at(index, i)].forgetPush();
  }
}

}  // namespace hapticd::servo
