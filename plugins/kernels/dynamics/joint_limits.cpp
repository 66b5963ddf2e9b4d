// SPDX-License-Identifier: MIT
#include "kernels/dynamics/joint_limits.hpp"

#include <cstdio>
#include <stdexcept>
#include <string>

namespace hapticd::dynamics {
namespace {

std::string listOf(const JointLimits& limits) {
  char text[80];
  std::snprintf(text, sizeof text, "[%g, %g]", limits.lowest, limits.highest);
  return text;
}

}  // namespace

void validate(const JointLimits& limits) {
  const auto refuse = [given = "limits: " + listOf(limits)](const std::string& why) {
    throw std::invalid_argument(given + why);
  };
  if (std::isnan(limits.lowest) || std::isnan(limits.highest))
    refuse(" contains a value that is not a number; expected [lowest, highest]");
  if (limits.lowest > limits.highest)
    refuse(" has the greater value first; expected [lowest, highest]: " + listOf({limits.highest, limits.lowest}));
  if (limits.lowest == limits.highest)
    refuse(
        " leaves no room to move; expected [lowest, highest] with lowest below highest, or motion: static for a "
        "body that does not move");
  if (limits.lowest > 0 || limits.highest < 0)
    refuse(
        " does not contain 0, the pose in which the scene places the body, from which limits count; expected lowest "
        "at most 0 and highest at least 0; to begin elsewhere, change the pose");
}

Stop holdInRange(const JointLimits& limits, double& position, double& rate) noexcept {
  if (position >= limits.highest) {
    position = limits.highest;
    if (rate > 0) rate = 0;
    return Stop::kHighest;
  }
  if (position <= limits.lowest) {
    position = limits.lowest;
    if (rate < 0) rate = 0;
    return Stop::kLowest;
  }
  return Stop::kNone;
}

Stop stopAt(const JointLimits& limits, double position) noexcept {
  constexpr double kRounding = 1e-9;  // [rad or m] a position along an axis in the world is rounded
  if (position >= limits.highest - kRounding) return Stop::kHighest;
  return position <= limits.lowest + kRounding ? Stop::kLowest : Stop::kNone;
}

}  // namespace hapticd::dynamics
