// SPDX-License-Identifier: MIT
/// Refuses joint limits that begin with the greater number.
#pragma once
#include <cstdio>
#include <vector>

#include "kinematics/error_collector.hpp"

namespace hapticd::kinematics {

/// [main] Notes a problem for each row [least, greatest] of arm.limits in the wrong order.
inline void refuseReversedLimits(const std::vector<double>& limits, ErrorCollector& wrong) {
  for (size_t i = 0; i + 1 < limits.size(); i += 2) {
    if (limits[i] <= limits[i + 1]) continue;
    char text[120];
    std::snprintf(text, sizeof text, "arm.limits[%zu]: [%g, %g], expected the smaller number first", i / 2, limits[i],
                  limits[i + 1]);
    wrong.add(text);
  }
}

}  // namespace hapticd::kinematics
