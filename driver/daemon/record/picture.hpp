// SPDX-License-Identifier: MIT
/// A picture of a run: depth, force and lateness over time, with their histograms beside them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/report.hpp"

namespace hapticd::record {

/// One tick to draw.
struct Sample {
  double t = 0;        ///< [s]
  double depth_m = 0;  ///< negative: distance outside
  double force_n = 0;
  double lateness_us = 0, compute_us = 0;
  std::array<double, 3> position_m{};  ///< of the tip; drawn where it is asked for
};

/// [main] Draws the run as SVG. Long runs are drawn by the range of each pixel column, so that no peak is lost.
/// @param positions draw a row for each coordinate of the tip too
Result<void> drawRun(const RunReport& report, const std::vector<Sample>& samples, const std::string& file,
                     bool positions = false);

}  // namespace hapticd::record
