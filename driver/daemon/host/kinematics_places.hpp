// SPDX-License-Identifier: MIT
/// Joint positions at which the kinematics of any arm are tested. A set of joint positions is called a place.
#pragma once
#include <algorithm>
#include <cmath>

#include "host/kinematics_calls.hpp"

namespace hapticd::host {

constexpr int kPlaces = 12;

/// Returns one of several places within 0.9 rad of zero. They avoid 0 and right angles, where arms are singular.
inline Joints anyPlace(int index) {
  Joints q;
  for (int i = 0; i < HDV_MAX_JOINTS; ++i) q[i] = 0.9 * std::sin(1.7 * (index + 1) + 2.3 * i);
  return q * (index % 3 == 0 ? 0.3 : 1.0);
}

/// [rad or m] Farther than any joint moves: if a stop is beyond this, the joint has no stops.
inline constexpr double kFarthestStop = 1e3;

/// Like anyPlace(), but spread over the range between the joint's stops, if it has stops.
inline Joints placeBetweenStops(int index, const hdv_info& info) {
  Joints q = anyPlace(index);
  for (uint32_t i = 0; i < info.joint_count && i < HDV_MAX_JOINTS; ++i) {
    const double low = info.position_min[i], high = info.position_max[i];
    if (low < high && std::abs(low) <= kFarthestStop && std::abs(high) <= kFarthestStop)
      q[i] = (low + high) / 2 + (high - low) / 2 * q[i];
    else if (!(low == 0 && high == 0))  // 0 to 0 means that the module gives no stops
      q[i] = std::clamp(q[i], low, high);
  }
  return q;
}

}  // namespace hapticd::host
