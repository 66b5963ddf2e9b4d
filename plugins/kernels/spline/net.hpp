// SPDX-License-Identifier: MIT
/// Control points as the kernels read them: scaled where coordinates are extreme, weights about 1.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

struct Net {
  std::vector<Quad> points;
  double scale = 1;  ///< a power of two: coordinates = scale * stored ones; 1 for all but extreme coordinates
  Weights weights = Weights::kNone;  ///< kNone also if all weights are equal
  bool rational() const noexcept { return weights != Weights::kNone; }
};

/// [main] For valid points and weights.
Net makeNet(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights);

}  // namespace hapticd::spline
