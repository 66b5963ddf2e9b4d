// SPDX-License-Identifier: MIT
/// Poses for a scene that bring a part before the hand.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace hapticd::cli {

struct PartPose {
  std::string name;          ///< for programs
  Eigen::Vector3d position;  ///< [m]
  std::string orientation;   ///< such as "[0.7071068, -0.7071068, 0, 0]"; empty: not turned
};

/// [any] Returns the poses that centre a part: as it is, and with its z up, as most CAD programs draw.
std::vector<PartPose> centringPoses(const Eigen::AlignedBox3d& box);

/// [any] Returns a pose as a scene takes it, such as "pose: {position: [0, 0.01, 0]}".
std::string poseText(const PartPose& pose);

}  // namespace hapticd::cli
