// SPDX-License-Identifier: MIT
#include "session/watched_servo.hpp"

#include "base/os.hpp"

namespace hapticd::servo {

WatchedServo::WatchedServo(const Loop& loop, World& world, std::vector<std::unique_ptr<Arm>>& arms,
                           const Telemetry& telemetry)
    : loop_(loop), world_(world), arms_(arms), telemetry_(telemetry) {
  for (const auto& arm : arms_) simulated_ = simulated_ && arm->simulated();
}

void WatchedServo::cut(double stuck_for) noexcept {
  for (const auto& arm : arms_) arm->cut(stuck_for);
}

const host::ShapeInstance* WatchedServo::culprit() const noexcept {
  // A search that crashes does so in its own thread; whoever else asks means the servo's.
  const bool search = os::threadId() == world_.proximity().thread() && world_.proximity().searching() >= 0;
  const int index = search ? world_.proximity().searching() : world_.core().stepping();
  const auto models = world_.core().models();
  return index >= 0 && static_cast<size_t>(index) < models.size() ? models[static_cast<size_t>(index)].shape : nullptr;
}

const char* WatchedServo::plugin() const noexcept {
  const host::ShapeInstance* shape = culprit();
  return shape != nullptr ? shape->description().name : nullptr;
}

const char* WatchedServo::model() const noexcept {
  const host::ShapeInstance* shape = culprit();
  return shape != nullptr ? shape->name().c_str() : nullptr;
}

const void* WatchedServo::blackBox() const noexcept {
  return telemetry_.flight() != nullptr ? telemetry_.flight()->ring().image() : nullptr;
}

size_t WatchedServo::blackBoxBytes() const noexcept {
  return telemetry_.flight() != nullptr ? telemetry_.flight()->ring().imageBytes() : 0;
}

}  // namespace hapticd::servo
