// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "module.hpp"

namespace hapticd::simulated {

/// Every position of a second of stroking with a spring wall of 800 N/m in the way.
inline std::vector<double> strokeOf(Module& arm, int milliseconds = 1000) {
  std::vector<double> all;
  EXPECT_EQ(arm.start(), HSP_OK) << arm.said;
  for (int i = 0; i < milliseconds; ++i) {
    arm.read(kMillisecond);
    all.insert(all.end(), arm.sample.position, arm.sample.position + 3);
    const double depth = 0.04 - arm.tip().norm();
    arm.write(HDV_TORQUE, arm.torqueOf(depth > 0 ? Eigen::Vector3d(800 * depth * arm.tip().normalized())
                                                 : Eigen::Vector3d::Zero()));
  }
  return all;
}

}  // namespace hapticd::simulated
