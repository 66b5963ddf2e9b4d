// SPDX-License-Identifier: MIT
/// The distance from a point to a triangle.
#pragma once
#include <Eigen/Core>

namespace hapticd::drawing {

/// [any] Returns the distance [m] from p to the triangle a, b, c, which may be a line or a point.
double distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace hapticd::drawing
