// SPDX-License-Identifier: MIT
/// Counts in how many ticks each joint of an arm was at the end of its range, where its mechanical stop pushes on the
/// hand.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "hapticd/device.h"

namespace hapticd::servo {

class StopCounts {
 public:
  static constexpr double kAt = 1e-4;  ///< [rad] or [m] a joint nearer than this to its stop counts

  /// [rt] Counts one tick with a good sample.
  void add(const hdv_info& info, const hdv_sample& sample) noexcept HSP_RT {
    for (uint32_t i = 0; i < info.joint_count && i < HDV_MAX_JOINTS; ++i) {
      // A joint without a range has no stop: the arm reports none.
      if (!(info.position_max[i] - info.position_min[i] > 2 * kAt)) continue;
      const double q = sample.position[i];
      if (q <= info.position_min[i] + kAt || q >= info.position_max[i] - kAt) ++ticks_[i];
    }
  }
  uint64_t ticks(uint32_t joint) const noexcept { return ticks_[joint]; }

 private:
  std::array<uint64_t, HDV_MAX_JOINTS> ticks_{};
};

}  // namespace hapticd::servo
