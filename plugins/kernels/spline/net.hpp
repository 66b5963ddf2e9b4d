// SPDX-License-Identifier: MIT
/// Control points in the form that the kernels read. Weights are scaled to about 1. Coordinates are scaled if they are
/// extreme.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

struct Net {
  std::vector<Quad> points;
  double scale = 1;  ///< a power of two: coordinates = scale * stored coordinates; 1 unless coordinates are extreme
  Weights weights = Weights::kNone;  ///< kNone also if all weights are equal
  bool rational() const noexcept { return weights != Weights::kNone; }
};

/// [main] Returns the net of points and weights, which must have passed validatePoints().
Net makeNet(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights);

}  // namespace hapticd::spline
