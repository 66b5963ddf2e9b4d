// SPDX-License-Identifier: MIT
#include "servo/core/core.hpp"

#include <algorithm>

#include "base/clock.hpp"

namespace hapticd::servo {

namespace {

using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

/// Returns a time in ns. The first ticks of a rerun, in which a model settles, lie before time 0 and count as 0.
Nanoseconds nanosecondsOf(double t) noexcept {
  return static_cast<Nanoseconds>(std::max(t, 0.0) * 1e9);
}

}  // namespace

Core::Core(const std::vector<host::ShapeInstance*>& models, const scene::Scene& scene, uint32_t probe_count,
           const CoreSettings& settings, link::Link& link)
    : settings_(settings),
      link_(link),
      probe_count_(probe_count),
      models_(models.size() + settings.spare_models),
      claims_(models_.size() * probe_count),
      energies_(models_.size() * probe_count),
      contacts_(models_.size() * probe_count),
      inputs_(probe_count),
      outputs_(probe_count),
      last_position_(probe_count, Vector3d::Zero()),
      last_orientation_(probe_count, Eigen::Quaterniond::Identity()),
      jumped_(probe_count),
      seen_(probe_count),
      forces_(probe_count, Vector3d::Zero()),
      torques_(probe_count, Vector3d::Zero()),
      exchanges_(probe_count),
      present_(static_cast<uint32_t>(models.size())) {
  serve(RequiredResults{});
  claim_step_.former = settings.former_claims;
  for (size_t i = 0; i < models.size(); ++i) models_[i] = stateOf(*models[i], scene.models[i], settings.keep_disabled);
  live_.reserve(models_.size());
  loads_.reserve(models_.size());
  listLive();
}

ModelState Core::stateOf(host::ShapeInstance& shape, const scene::Model& described, bool keep_disabled) {
  ModelState model;
  model.shape = &shape;
  Map(model.pose.position) = described.pose.position;
  storeQuaternion(described.pose.orientation, model.pose.orientation);
  model.frame = Frame::of(model.pose);
  const bool moves_itself = (shape.report().flags & HSP_R_MOVES) != 0;
  model.kinematic = described.kinematic;
  if (described.kinematic) {
    const std::vector<scene::PathPoint> rests{{0, described.pose}};
    model.path = Path(described.path.empty() ? rests : described.path);
  }
  model.moves = moves_itself || described.kinematic;
  model.always = moves_itself || shape.surfaces() == nullptr;
  const hsp_report& report = shape.report();
  model.claims.stiffness = report.max_stiffness;
  model.claims.damping = shape.claimedDamping();
  model.claims.jump = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  model.claims.moves_itself = moves_itself;
  model.dormant = keep_disabled && !described.enabled;
  model.enabled = !model.dormant;
  if (model.dormant) model.guard.startAtZero();  // so that its force fades in
  return model;
}

void Core::serve(const RequiredResults& uses) {
  uses_ = uses;
  uses_.max_force.resize(probe_count_, 0);
  uses_.max_torque.resize(probe_count_, 0);
}

double Core::deepest(uint32_t probe) const noexcept HSP_RT {
  double depth = 0;
  for (const uint32_t i : live_) {
    const Contact& held = contact(i, probe);
    if (held.traced && held.world.depth_m > depth) depth = held.world.depth_m;
  }
  return depth;
}

void Core::publish(double t, std::span<const Probe> probes) noexcept HSP_RT {
  link::ArmState& arm = link_.arm.back();
  arm.time_ns = nanosecondsOf(t);
  arm.probe_count = probe_count_;
  for (uint32_t i = 0; i < probe_count_; ++i) {
    arm.valid[i] = probes[i].valid;
    Map(arm.position[i].data()) = probes[i].position;
    arm.depth[i] = deepest(i);
  }
  link_.arm.publish();
}

void Core::tick(double t, double dt, std::span<const Probe> probes) noexcept HSP_RT {
  receiveRecords();
  needs_search_ = false;
  preempted_ = false;
  cpu_timed_ = suspicious_ > 0;
  if (suspicious_ > 0) --suspicious_;
  transforms_ = 0;
  budget_left_ns_ = settings_.budget_ns;
  findJumps(dt, probes);
  for (uint32_t i = 0; i < probe_count_; ++i) {
    forces_[i].setZero();
    torques_[i].setZero();
    exchanges_[i] = {0, 0};
  }
  for (const uint32_t i : live_) {
    ModelState& model = models_[i];
    model.overran = false;
    if (model.moves) model.before = model.frame;
    if (model.kinematic) moveKinematic(model, t, dt);
    if (model.level == Accuracy::kCoarsest && mayRest(model, i, dt)) {
      model.rested += dt;
      model.step_ns = 0;
      ++model.degraded_ticks;
      continue;
    }
    if (isTraced(model)) stepModel(i, t, dt, probes);
    if (model.moves) sendTransform(model, i);
  }
  releaseLeaving();
  ++tick_;
}

void Core::moveKinematic(ModelState& model, double t, double dt) noexcept HSP_RT {
  if (model.lead.active())
    model.lead.step(t, dt, epoch_, model.pose);
  else if (model.glide.active())
    model.glide.at(t, model.pose);
  else
    model.path.at(t, model.pose);
  model.frame = Frame::of(model.pose);
}

bool Core::isTraced(const ModelState& model) noexcept HSP_RT {
  return !model.dormant && (model.always || model.active_surfaces > 0);
}

void Core::listLive() noexcept HSP_RT {
  live_.clear();
  for (uint32_t i = 0; i < models_.size(); ++i) {
    ModelState& model = models_[i];
    const bool traced = isTraced(model);
    const bool moves = model.moves && (!model.dormant || model.kinematic);  // a dormant body rests where it begins
    if (traced || moves) live_.push_back(i);  // capacity is reserved for all models, so this never allocates
    if (traced) continue;
    clearContacts(i);  // a model on a path still moves, but has no foot point, and so no coarse one
    if (model.status == HSP_DEGRADED) model.status = HSP_OK;
  }
}

void Core::receiveRecords() noexcept HSP_RT {
  bool changed = false;
  for (received_count_ = 0; received_count_ < received_.size() && link_.records.pop(received_[received_count_]);
       ++received_count_) {
    const link::ActivationRecord& record = received_[received_count_];
    ModelState& model = models_[record.model];
    if (model.shape == nullptr) continue;  // the model has left the run
    if (record.order == link::ActivationRecord::Order::kStop) {
      model.shape->deactivate(record.near.probe, record.near.surface);
      changed |= --model.active_surfaces == 0;
    } else {
      model.shape->activate(record.near);
      if (record.order == link::ActivationRecord::Order::kStart) changed |= model.active_surfaces++ == 0;
    }
  }
  if (changed) listLive();
}

void Core::findJumps(double dt, std::span<const Probe> probes) noexcept HSP_RT {
  const bool unseen = settings_.gaps_jump && dt > kLongestGap;
  for (uint32_t i = 0; i < probe_count_; ++i) {
    jumped_[i] = 0;
    if (!probes[i].valid) {
      needs_search_ = true;  // the tip may be far away in the next sample
      continue;
    }
    const double travel = (probes[i].position - last_position_[i]).norm();
    if (seen_[i] != 0 && (unseen || travel > settings_.max_probe_speed * dt)) {
      jumped_[i] = 1;
      needs_search_ = true;
    }
    seen_[i] = 1;
    last_position_[i] = probes[i].position;
    last_orientation_[i] = probes[i].orientation;
  }
}

void Core::fillProbe(const ModelState& model, const Probe& probe, uint32_t index, double t) noexcept HSP_RT {
  hsp_probe& in = inputs_[index];
  in = hsp_probe{};
  in.orientation[0] = 1;
  in.time_ns = nanosecondsOf(t);
  if (jumped_[index] != 0) in.flags |= HSP_IN_JUMP;
  if (!probe.valid) in.flags |= HSP_IN_INVALID;
  const Vector3d& p_world = last_position_[index];  // from the last good sample
  Map(in.position) = model.frame.pointToModel(p_world);
  if (!model.frame.identity) ++transforms_;
  const uint32_t needs = model.shape->report().flags;
  if ((needs & HSP_R_VELOCITY) != 0 && probe.valid) {
    const Vector3d arm = p_world - ConstMap(model.pose.position);
    const Vector3d surface = ConstMap(model.pose.linear) + ConstMap(model.pose.angular).cross(arm);
    Map(in.velocity) = model.frame.vectorToModel(probe.velocity - surface);
  }
  if ((needs & HSP_R_ORIENTATION) != 0) {
    storeQuaternion(quaternionOf(model.pose.orientation).conjugate() * probe.orientation, in.orientation);
  }
}

void Core::stepModel(uint32_t index, double t, double dt, std::span<const Probe> probes) noexcept HSP_RT {
  ModelState& model = models_[index];
  if (model.guard.silenced() && model.guard.gain(false, false, dt) == 0) return clearContacts(index);
  for (uint32_t i = 0; i < probe_count_; ++i) {
    fillProbe(model, probes[i], i, t);
    outputs_[i] = hsp_contact{};
  }
  hsp_pose pose = model.pose;
  callShape(model, dt, pose);
  const ShapeFault fault = checkAnswer(model, index, dt, pose);
  if (model.breach.force > 0 && model.breach.t < 0) model.breach.t = t;
  const double gain_before = model.guard.gain();
  const bool good = fault == ShapeFault::kNone;
  double pace = dt;
  const bool wanted = model.enabled && (!model.until_free || !good || enters(model, probes, pace));
  const double gain = model.guard.gain(good, wanted, pace);
  const double fade = gain_before > 0 ? gain / gain_before : 0;
  model.at_end = 0;
  for (uint32_t i = 0; i < probe_count_; ++i) {
    model.at_end |= outputs_[i].flags & (HSP_OUT_AT_LOWEST | HSP_OUT_AT_HIGHEST);
    if (good) {
      takeContact(model, index, i, gain);
    } else {
      fadeContact(index, i, fade);
    }
    Contact& contact = contacts_[at(index, i)];
    if (!probes[i].valid) {
      contact = Contact{};
      continue;
    }
    forces_[i] += ConstMap(contact.world.force);
    if (uses_.torque) torques_[i] += ConstMap(contact.world.torque);
    if (uses_.exchange) recordContact(model, contact, i);
  }
}

/// Runs the plugin on inputs_, fills outputs_, and measures the time if the settings ask for it.
void Core::callShape(ModelState& model, double dt, hsp_pose& pose) noexcept HSP_RT {
  hsp_step step{};
  step.struct_size = sizeof step;
  step.count = probe_count_;
  step.in = inputs_.data();
  step.in_stride = sizeof(hsp_probe);
  step.out = outputs_.data();
  step.out_stride = sizeof(hsp_contact);
  step.dt_s = dt + model.rested;
  model.rested = 0;
  step.budget_ns = budget_left_ns_;
  const Accuracy accuracy = Accuracy::of(model.level);
  step.max_iterations = accuracy.max_iterations;
  step.order = accuracy.order;
  step.pose = &pose;
  step.changes = model.changes.data();
  step.change_count = model.change_count;
  model.change_count = 0;

  const CostStart begun = beginCost();
  model.status = model.guard.silenced() ? HSP_E_STATE : model.shape->step(step);
  if (model.level > 0) {
    ++model.degraded_ticks;
    if (model.status == HSP_OK) model.status = HSP_DEGRADED;
  }
  if (settings_.measure) takeCost(model, begun);
}

void Core::sendTransform(ModelState& model, uint32_t index) noexcept HSP_RT {
  link::ModelTransform transform;
  transform.model = index;
  for (size_t i = 0; i < 3; ++i) transform.position[i] = model.pose.position[i];
  for (size_t i = 0; i < 4; ++i) transform.orientation[i] = model.pose.orientation[i];
  link_.transforms.push(transform);  // if the queue is full, the transform is lost; the next tick sends a newer one
}

}  // namespace hapticd::servo
