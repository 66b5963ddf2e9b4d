// SPDX-License-Identifier: MIT
/// Joint positions at which the kinematics of any arm are tried.
#pragma once
#include <algorithm>
#include <cmath>

#include "host/kinematics_calls.hpp"

namespace hapticd::host {

constexpr int kPlaces = 12;

/// Places spread over a radian, none of them special: arms are singular at 0 and right angles.
inline Joints anyPlace(int index) {
  Joints q;
  for (int i = 0; i < HDV_MAX_JOINTS; ++i) q[i] = 0.9 * std::sin(1.7 * (index + 1) + 2.3 * i);
  return q * (index % 3 == 0 ? 0.3 : 1.0);
}

/// [rad or m] No arm moves farther: stops beyond this mean that the arm has none.
inline constexpr double kFarthestStop = 1e3;

/// The same, spread over the range between the stops, if there are any.
inline Joints placeBetweenStops(int index, const hdv_info& info) {
  Joints q = anyPlace(index);
  for (uint32_t i = 0; i < info.joint_count && i < HDV_MAX_JOINTS; ++i) {
    const double low = info.position_min[i], high = info.position_max[i];
    if (low < high && std::abs(low) <= kFarthestStop && std::abs(high) <= kFarthestStop)
      q[i] = (low + high) / 2 + (high - low) / 2 * q[i];
    else if (!(low == 0 && high == 0))  // a module that fills in no stops has none
      q[i] = std::clamp(q[i], low, high);
  }
  return q;
}

}  // namespace hapticd::host
