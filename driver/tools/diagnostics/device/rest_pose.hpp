// SPDX-License-Identifier: MIT
/// Finds a pose in which a serial arm can be pushed, from its table of links alone.
#pragma once
#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "document/node.hpp"

namespace hapticd::diagnostics {

struct RestPose {
  std::vector<double> joints;                     ///< [rad]
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< [m] device frame
  /// unit vector (device frame) along which the tip can move; z if possible
  Eigen::Vector3d push = Eigen::Vector3d::UnitZ();
  int freedom = 3;     ///< number of independent directions in which the tip can move; 2 for a flat arm
  bool flat = false;   ///< the tip can move in two directions only, so that it stays in a plane
  bool middle = true;  ///< each joint is in the middle of its limits, or at 0 if it has none
};

/// [main] Returns the three numbers below a key, or zeros if they are missing.
Eigen::Vector3d vectorBelow(const document::Node& map, std::string_view key);

/// [main] Returns the middle of arm.limits (0 for joints without limits) if the tip can move well from there. Otherwise
/// returns the nearest bent pose from which it can. From a stretched pose the tip cannot move along the arm.
/// @param arm the block `arm` of a device file, with kind: chain
RestPose restPoseOf(const document::Node& arm);

}  // namespace hapticd::diagnostics
