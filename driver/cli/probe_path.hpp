// SPDX-License-Identifier: MIT
/// Probe paths of `hapticd trace`: CSV with a header line t,x,y,z[,qw,qx,qy,qz].
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::cli {

/// One tick of a prescribed path, world frame. Positions and orientations may be not-a-numbers: a bad sample. Finite
/// orientations have the length 1, to seven digits.
struct PathRow {
  double t = 0;              ///< [s]
  Eigen::Vector3d position;  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  bool finite() const { return position.allFinite() && orientation.coeffs().allFinite(); }
};

/// [main] Reads and checks a whole file: times must be finite and grow. Errors name file, line and column.
Result<std::vector<PathRow>> readProbePath(const std::string& file);

}  // namespace hapticd::cli
