// SPDX-License-Identifier: MIT
/// The motion of a kinematic model: a pose at every time, from points of a file.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "hapticd/shape.h"

namespace hapticd::servo {

class Path {
 public:
  Path() = default;
  explicit Path(std::vector<scene::PathPoint> points) : points_(std::move(points)) {}  ///< [main] times grow

  bool empty() const noexcept { return points_.empty(); }

  /// [rt] Pose and velocities at time t [s]: linear and spherical interpolation; at rest before the first and after the
  /// last point. Remembers the segment, so that growing times cost nothing.
  void at(double t, hsp_pose& pose) noexcept;

 private:
  std::vector<scene::PathPoint> points_;
  size_t segment_ = 0;
};

}  // namespace hapticd::servo
