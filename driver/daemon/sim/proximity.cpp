// SPDX-License-Identifier: MIT
#include "sim/proximity.hpp"

#include <algorithm>

namespace hapticd::sim {

using link::ActivationRecord;

Proximity::Proximity(const std::vector<host::ShapeInstance*>& models, const std::vector<hsp_pose>& poses,
                     uint32_t probe_count, const ProximitySettings& settings, link::Link& link)
    : settings_(settings), link_(link), of_scene_(models.size(), UINT32_MAX) {
  for (uint32_t i = 0; i < models.size(); ++i) addModel(i, *models[i], poses[i], probe_count);
}

void Proximity::addModel(uint32_t place, host::ShapeInstance& shape, const hsp_pose& pose, uint32_t probe_count) {
  if (shape.surfaces() == nullptr) return;
  const uint32_t surfaces = shape.surfaceCount();
  Model model{place, &shape, surfaces, shape.report().locked_bytes, {}, {}, false, {}, {}, {}, 0};
  model.has_box = shape.bounds(model.box_min.data(), model.box_max.data());
  model.position = Eigen::Vector3d(pose.position);
  const double* q = pose.orientation;
  model.orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  model.active.assign(size_t{probe_count} * surfaces, 0);
  constexpr uint32_t kRivals = 32;  // room for further feet, because a plugin may offer several feet on one surface
  found_.resize(std::max<size_t>(found_.size(), size_t{surfaces} + kRivals));
  seen_.resize(std::max<size_t>(seen_.size(), surfaces));
  if (of_scene_.size() <= place) of_scene_.resize(place + 1, UINT32_MAX);
  const auto gone = std::find_if(models_.begin(), models_.end(), [](const Model& m) { return m.index == UINT32_MAX; });
  of_scene_[place] = static_cast<uint32_t>(gone - models_.begin());
  if (gone == models_.end())
    models_.push_back(std::move(model));
  else
    *gone = std::move(model);
}

void Proximity::add(uint32_t place, host::ShapeInstance& shape, const hsp_pose& pose, uint32_t probe_count) {
  const std::lock_guard lock(mutex_);
  addModel(place, shape, pose, probe_count);
}

void Proximity::remove(uint32_t place) {
  const std::lock_guard lock(mutex_);
  if (place >= of_scene_.size() || of_scene_[place] == UINT32_MAX) return;
  models_[of_scene_[place]].index = UINT32_MAX;
  of_scene_[place] = UINT32_MAX;
}

bool Proximity::contains(uint32_t place) const {
  const std::lock_guard lock(mutex_);
  return place < of_scene_.size() && of_scene_[place] != UINT32_MAX;
}

size_t Proximity::modelCount() const {
  const std::lock_guard lock(mutex_);
  return static_cast<size_t>(
      std::count_if(models_.begin(), models_.end(), [](const Model& m) { return m.index != UINT32_MAX; }));
}

Searching Proximity::amount() const {
  constexpr uint64_t kSmallBytes = 512 * 1024;  // [bytes] a torus has half as many, and is searched in less than 20 us
  const std::lock_guard lock(mutex_);
  uint32_t surfaces = 0;
  uint64_t bytes = 0;
  for (const Model& model : models_) {
    if (model.index == UINT32_MAX) continue;
    surfaces += model.surfaces;
    bytes += model.bytes;
  }
  if (surfaces == 0) return Searching::kNone;
  return surfaces == 1 && bytes <= kSmallBytes ? Searching::kSmall : Searching::kLarge;
}

void Proximity::search() {
  const std::lock_guard lock(mutex_);
  receiveTransforms();
  link_.arm.update();
  const link::ArmState& arm = link_.arm.front();
  for (uint32_t probe = 0; probe < arm.probe_count; ++probe) {
    if (!arm.valid[probe]) continue;
    const Eigen::Vector3d p_world(arm.position[probe].data());
    for (Model& model : models_)
      if (model.index != UINT32_MAX) searchModel(model, probe, p_world, arm.depth[probe]);
  }
  link_.records.publish();
}

void Proximity::receiveTransforms() {
  link::ModelTransform transform;
  while (link_.transforms.pop(transform)) {
    const uint32_t index = transform.model < of_scene_.size() ? of_scene_[transform.model] : UINT32_MAX;
    if (index == UINT32_MAX) continue;
    models_[index].position = Eigen::Vector3d(transform.position.data());
    const auto& q = transform.orientation;
    models_[index].orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  }
}

void Proximity::searchModel(Model& model, uint32_t probe, const Eigen::Vector3d& p_world, double depth) {
  // A foot point is as far away as the contact is deep. In one period of the search a probe at 2 m/s moves 10 mm.
  constexpr double kMovedMeanwhile = 0.01;  // [m]
  const double held = depth > 0 ? depth + kMovedMeanwhile : 0;
  const double near_by = std::max(settings_.activation_radius, held);
  const double reach = std::max(settings_.activation_radius + settings_.hysteresis, held);
  const Eigen::Vector3d p_model = model.orientation.conjugate() * (p_world - model.position);
  const Eigen::Vector3d to_box = p_model - p_model.cwiseMax(model.box_min).cwiseMin(model.box_max);
  const bool may_be_near = !model.has_box || to_box.norm() <= reach;
  if (!may_be_near && model.active_count == 0) return;

  const uint32_t count = model.surfaces;
  std::fill_n(seen_.begin(), count, uint8_t{0});
  const size_t found = may_be_near ? model.shape->nearby(p_model.data(), reach, found_) : 0;
  uint8_t* active = &model.active[size_t{probe} * count];
  for (size_t i = 0; i < found; ++i) {
    hsp_near near = found_[i];
    near.probe = probe;
    seen_[near.surface] = 1;
    if (active[near.surface] != 0) {
      send(model, ActivationRecord::Order::kOffer, near);
    } else if (near.distance_m <= near_by && send(model, ActivationRecord::Order::kStart, near)) {
      active[near.surface] = 1;
      ++model.active_count;
    }
  }
  stopLeft(model, probe);
}

void Proximity::stopLeft(Model& model, uint32_t probe) {
  const uint32_t count = model.surfaces;
  uint8_t* active = &model.active[size_t{probe} * count];
  for (uint32_t surface = 0; surface < count && model.active_count > 0; ++surface) {
    if (active[surface] == 0 || seen_[surface] != 0) continue;
    if (!send(model, ActivationRecord::Order::kStop, hsp_near{surface, probe, {0, 0}, 0})) return;
    active[surface] = 0;
    --model.active_count;
  }
}

bool Proximity::send(const Model& model, ActivationRecord::Order order, const hsp_near& near) {
  return link_.records.add(ActivationRecord{model.index, order, near});
}

}  // namespace hapticd::sim
