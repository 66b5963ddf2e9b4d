// SPDX-License-Identifier: MIT
#include "session/replay/later_models.hpp"

#include <algorithm>
#include <cstring>

#include "session/telemetry/flight.hpp"

namespace hapticd::servo {

const RunModel* laterModel(const std::vector<RunModel>& described, uint32_t number, uint64_t tick) {
  const auto is = [&](const RunModel& one) { return one.number == number && one.since <= tick; };
  const auto found = std::find_if(described.rbegin(), described.rend(), is);
  return found != described.rend() ? &*found : nullptr;
}

uint32_t LaterModels::placesFor(const std::vector<RunModel>& described, size_t of_scene) {
  constexpr uint32_t kMost = 4096;  // a larger number of a model is damage, because no run has so many places
  size_t places = of_scene;
  for (const RunModel& one : described)
    if (one.number < kMost) places = std::max(places, size_t{one.number} + 1);
  return static_cast<uint32_t>(places - of_scene);
}

void LaterModels::build(const record::RecordedStream& orders, const std::vector<RunModel>& described,
                        const World& world, const host::Services::Log& log) {
  for (uint64_t i = 0; i < orders.rows() && end_ == UINT64_MAX; ++i) {
    OrderRow row;
    std::memcpy(&row, orders.row(i), sizeof row);
    if (row.kind != static_cast<uint32_t>(Order::Kind::kAdopt)) continue;
    const RunModel* model = laterModel(described, row.target, row.tick);
    const std::string lack = add(model, world, log);
    if (lack.empty()) continue;
    end_ = row.tick;
    why_ = "the replay ends at tick " + std::to_string(end_) + ", in which " +
           (model != nullptr ? "\"" + model->model.name + "\"" : "a model") + " was added: " + lack;
  }
}

/// Builds one model. Returns why that is impossible, or "".
std::string LaterModels::add(const RunModel* described, const World& world, const host::Services::Log& log) {
  if (described == nullptr || described->number >= world.places()) return "the recording is damaged";
  if (!described->lack.empty()) return described->lack;
  auto shape = world.prepare(described->model, log);
  if (!shape) return shape.error();
  ModelState state = Core::stateOf(**shape, described->model);
  built_.push_back({std::move(*shape), described->model, std::move(state)});
  return "";
}

ModelState* LaterModels::adopt(uint32_t place, World& world) {
  if (next_ == built_.size()) return nullptr;
  Built& came = built_[next_++];
  if (place >= world.places() || world.shapes()[place] != nullptr) return nullptr;
  world.store(place, std::move(came.shape), came.model);
  return &came.state;
}

}  // namespace hapticd::servo
