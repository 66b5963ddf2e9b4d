// SPDX-License-Identifier: MIT
/// A picture of a run: depth, force and lateness over time, each with a scale and a histogram of its own.
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "record/report.hpp"

namespace hapticd::record {

/// One tick to draw.
struct Sample {
  double t = 0;        ///< [s]
  double depth_m = 0;  ///< negative: distance outside; nan: nothing is traced
  int model = -1;      ///< of that depth, index in RunNotes::models; -1: none
  double force_n = 0;  ///< as sent
  double asked_n = 0;  ///< of the models, before the limits; nan: not known
  uint32_t fault = 0;  ///< of the arm, 0: none
  double lateness_us = 0, compute_us = 0;
  std::array<double, 3> position_m{};  ///< of the tip; drawn where it is asked for; nan: not known
};

/// What stands in a picture by name.
struct RunNotes {
  std::vector<std::string> models;
  double force_limit_n = 0;                               ///< limits.force of the arm; 0 or not finite: not drawn
  bool positions = false;                                 ///< a row for each coordinate of the tip too
  std::vector<std::pair<double, std::string>> moments{};  ///< [s] with what happened then: "ring is silenced"
  std::string arm{};                                      ///< whose samples these are, where there are several
};

/// Short words for a fault of a recording, "too fast"; from servo::Fault, whose numbers recordings keep.
std::string nameOfFault(uint32_t fault);

/// [main] Draws the run as SVG. Long runs are drawn by the range of each pixel column, so that no peak is lost.
Result<void> drawRun(const RunReport& report, const std::vector<Sample>& samples, const RunNotes& notes,
                     const std::string& file);

}  // namespace hapticd::record
