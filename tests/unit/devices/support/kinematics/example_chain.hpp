// SPDX-License-Identifier: MIT
/// A seven-joint arm with a spherical wrist, a sliding joint in a variant, and masses: every branch of the chain code.
#pragma once
#include "kinematics/chain.hpp"

namespace hapticd::kinematics {

inline ChainGeometry exampleChain(bool with_slider = false) {
  ChainGeometry geometry;
  const double alphas[] = {1, -1, 1, -1, 1, -1, 0.3};
  const double lengths[] = {0, 0, 0.31, 0, 0.27, 0, 0.05};
  for (int i = 0; i < 7; ++i) {
    ChainLink link;
    link.alpha = alphas[i] * M_PI / 2;
    link.d = lengths[i];
    link.a = i == 3 ? 0.02 : 0;
    link.theta = 0.1 * i;
    link.min = -2;
    link.max = 2;
    link.mass = 1.5 - 0.2 * i;
    link.center = Eigen::Vector3d(0.01 * i, -0.02, 0.03);
    const Eigen::Vector3d principal(0.01, 0.012, 0.005);
    link.inertia = principal.asDiagonal();
    link.inertia(0, 1) = link.inertia(1, 0) = 0.001;
    geometry.links.push_back(link);
  }
  if (with_slider) {
    geometry.links[2].sliding = true;
    geometry.links[2].min = 0;
    geometry.links[2].max = 0.3;
  }
  geometry.base.position = Eigen::Vector3d(0.1, 0.5, -0.2);
  geometry.base.orientation = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  geometry.tool.position = Eigen::Vector3d(0.02, 0.03, 0.1);
  geometry.tool.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()));
  return geometry;
}

}  // namespace hapticd::kinematics
