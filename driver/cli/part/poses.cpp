// SPDX-License-Identifier: MIT
#include "cli/part/poses.hpp"

#include <cmath>
#include <cstdio>

namespace hapticd::cli {
namespace {

/// Rounds to the micrometre, which no hand feels.
double rounded(double length) {
  return std::round(1e6 * length) * 1e-6 + 0.0;
}

}  // namespace

std::vector<PartPose> centringPoses(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d middle = box.center();
  const Eigen::Vector3d turned(middle.x(), middle.z(), -middle.y());  // y is up in the world
  return {{"centred", -middle, ""}, {"z_up", -turned, "[0.7071068, -0.7071068, 0, 0]"}};
}

std::string poseText(const PartPose& pose) {
  char text[120];
  std::snprintf(text, sizeof text, "pose: {position: [%.6g, %.6g, %.6g]", rounded(pose.position.x()),
                rounded(pose.position.y()), rounded(pose.position.z()));
  return text + (pose.orientation.empty() ? "" : ", orientation: " + pose.orientation) + "}";
}

}  // namespace hapticd::cli
