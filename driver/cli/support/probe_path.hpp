// SPDX-License-Identifier: MIT
/// Reads probe paths for `hapticd trace`: CSV with a header line t,x,y,z[,qw,qx,qy,qz].
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::cli {

/// One tick of a prescribed path, in the world frame. A position or orientation may be NaN, which means a bad sample. A
/// finite quaternion must have the length 1 to within 0.001.
struct PathRow {
  double t = 0;              ///< [s]
  Eigen::Vector3d position;  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  bool finite() const { return position.allFinite() && orientation.coeffs().allFinite(); }
};

/// [main] Reads and checks a whole file: times must be finite and grow. Errors name file, line and column.
Result<std::vector<PathRow>> readProbePath(const std::string& file);

}  // namespace hapticd::cli
