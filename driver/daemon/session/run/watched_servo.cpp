// SPDX-License-Identifier: MIT
#include "session/run/watched_servo.hpp"

#include <algorithm>

namespace hapticd::servo {

WatchedServo::WatchedServo(Loop& loop, Arms& arms, const Telemetry& telemetry)
    : loop_(loop), arms_(arms), telemetry_(telemetry), simulated_(onlySimulated(arms)) {}

void WatchedServo::cut(double stuck_for) noexcept {
  for (const auto& arm : arms_) arm->cut(stuck_for);
}

bool WatchedServo::cutLeft() const noexcept {
  return std::all_of(arms_.begin(), arms_.end(), [](const auto& arm) { return arm->cutLeft(); });
}

const void* WatchedServo::blackBox() const noexcept {
  return telemetry_.flight() != nullptr ? telemetry_.flight()->ring().image() : nullptr;
}

size_t WatchedServo::blackBoxBytes() const noexcept {
  return telemetry_.flight() != nullptr ? telemetry_.flight()->ring().imageBytes() : 0;
}

}  // namespace hapticd::servo
