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
  int model = -1;      ///< the model of that depth, index in RunNotes::models; -1: none
  double force_n = 0;  ///< as sent
  double asked_n = 0;  ///< force of the models, before the limits; nan: unknown
  uint32_t fault = 0;  ///< fault of the arm, 0: none
  double lateness_us = 0, compute_us = 0;
  std::array<double, 3> position_m{};  ///< position of the tip, drawn if asked for; nan: unknown
};

/// What a picture shows by name.
struct RunNotes {
  std::vector<std::string> models;
  double force_limit_n = 0;                               ///< limits.force of the arm; 0 or not finite: not drawn
  bool positions = false;                                 ///< adds a row for each coordinate of the tip
  std::vector<std::pair<double, std::string>> moments{};  ///< [s] times, and what happened then: "ring is silenced"
  std::string arm{};                                      ///< whose samples these are, if there are several arms
};

/// Short words for a fault of a recording, "too fast". It is a servo::Fault, whose numbers recordings keep.
std::string nameOfFault(uint32_t fault);

/// [main] Draws the run as SVG. Of a long run each pixel column shows the range of its values, so that no peak is lost.
Result<void> drawRun(const RunReport& report, const std::vector<Sample>& samples, const RunNotes& notes,
                     const std::string& file);

}  // namespace hapticd::record
