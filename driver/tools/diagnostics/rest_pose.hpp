// SPDX-License-Identifier: MIT
/// A pose in which a serial arm can be pushed, found from its table of links alone.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "document/node.hpp"

namespace hapticd::diagnostics {

struct RestPose {
  std::vector<double> joints;                       ///< [rad]
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();    ///< [m] device frame
  Eigen::Vector3d push = Eigen::Vector3d::UnitZ();  ///< a direction in which the tip can move: z where it can
  int freedom = 3;                                  ///< directions in which the tip moves: 2 of a flat arm
  bool flat = false;                                ///< of two of them, so that the tip stays in a plane
  bool middle = true;                               ///< each joint is in the middle of its limits, or at 0 without any
};

/// [main] Three numbers below a key, 0 if there are none.
Eigen::Vector3d vectorBelow(const document::Node& map, std::string_view key);

/// [main] The middle of arm.limits (0 without) where the tip moves well from there; otherwise the bent pose next to it
/// from which it does. Stretched out, an arm cannot be pulled further, nor brought in.
/// @param arm the block of a device file whose kind is chain
RestPose restPoseOf(const document::Node& arm);

}  // namespace hapticd::diagnostics
