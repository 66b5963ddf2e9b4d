// SPDX-License-Identifier: MIT
#include "drawing/triangle_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hapticd::drawing {
namespace {

double toSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + share * along - p).norm();
}

}  // namespace

double distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double length = n.norm();
  // p is above the triangle if it is on the inner side of the three planes that stand on its edges
  const bool above = length > 0 && n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                     n.dot((a - c).cross(p - c)) >= 0;
  if (above) return std::abs(n.dot(p - a)) / length;
  return std::min({toSegment(p, a, b), toSegment(p, b, c), toSegment(p, c, a)});
}

}  // namespace hapticd::drawing
