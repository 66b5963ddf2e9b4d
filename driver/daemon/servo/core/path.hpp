// SPDX-License-Identifier: MIT
/// The motion of a kinematic model from a file: interpolates a pose for every time between points.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "hapticd/shape.h"

namespace hapticd::servo {

class Path {
 public:
  Path() = default;
  explicit Path(std::vector<scene::PathPoint> points) : points_(std::move(points)) {}  ///< [main] times must grow

  bool empty() const noexcept { return points_.empty(); }

  /// [rt] Fills in pose and velocities at time t [s], by linear and spherical interpolation. The model rests before the
  /// first and after the last point. The last segment is remembered, so that growing times need no search.
  void at(double t, hsp_pose& pose) noexcept;

 private:
  std::vector<scene::PathPoint> points_;
  size_t segment_ = 0;
};

}  // namespace hapticd::servo
