// SPDX-License-Identifier: MIT
/// Tells the host at which end of its range the joint of a moving shape stands.
#pragma once
#include "hapticd/shape.h"
#include "kernels/dynamics/joint_limits.hpp"

namespace hapticd {

/// [rt] Returns the flags of every contact of a shape whose joint stands at this stop.
inline uint32_t endFlags(dynamics::Stop stop) noexcept HSP_RT {
  if (stop == dynamics::Stop::kNone) return 0;
  return stop == dynamics::Stop::kLowest ? uint32_t{HSP_OUT_AT_LOWEST} : uint32_t{HSP_OUT_AT_HIGHEST};
}

}  // namespace hapticd
