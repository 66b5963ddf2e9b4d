// SPDX-License-Identifier: MIT
/// A picture of a run: depth, force and lateness over time, each with its own scale and histogram.
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
  double depth_m = 0;  ///< [m] penetration depth; negative outside; nan if nothing is traced
  int model = -1;      ///< model of that depth, as an index into RunNotes::models; -1 if there is none
  double force_n = 0;  ///< [N] force that was sent to the arm
  double asked_n = 0;  ///< [N] force of the models, before the limits; nan if it is unknown
  uint32_t fault = 0;  ///< fault of the arm; 0 if there is none
  double lateness_us = 0, compute_us = 0;
  std::array<double, 3> position_m{};  ///< [m] position of the tip; nan if it is unknown
};

/// How a hinge or a slider moved.
struct JointTrack {
  std::string title, unit;
  std::vector<std::pair<double, double>> places;  ///< [s] time, and place in `unit`
  std::vector<double> stops;                      ///< end stops that it came to, in `unit`
};

/// Names and marks for a picture.
struct RunNotes {
  std::vector<std::string> models;
  double force_limit_n = 0;  ///< limits.force of the arm; not drawn if it is 0 or not finite
  bool positions = false;    ///< true to add a row for each coordinate of the tip
  std::vector<std::pair<double, std::string>> moments{};  ///< [s] times, with texts such as "ring is silenced"
  std::vector<std::pair<double, std::string>> marks{};    ///< [s] times of the marks of programs, with their texts
  std::vector<JointTrack> joints{};                       ///< a row for each
  std::string arm{};                                      ///< name of the arm of the samples, if there are several arms
};

/// Returns short words for a fault of a recording, such as "too fast". @param fault a servo::Fault as a number
std::string nameOfFault(uint32_t fault);

/// [main] Draws the run as an SVG file. In a long run, each column of pixels shows the range of its values, so that no
/// peak is lost.
Result<void> drawRun(const RunReport& report, const std::vector<Sample>& samples, const RunNotes& notes,
                     const std::string& file);

}  // namespace hapticd::record
