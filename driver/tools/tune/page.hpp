// SPDX-License-Identifier: MIT
/// What was measured, for people: a table, a picture, a page that needs no network, and JSON.
#pragma once
#include <string>
#include <vector>

#include "tune/search.hpp"
#include "tune/sweeps.hpp"

namespace hapticd::tune {

struct Findings {
  std::string scene;   ///< file
  std::string motion;  ///< where the probe's motion is from
  std::vector<Knob> knobs;
  Goal goal;
  Tuning tuning;
  std::vector<RateRow> rates;
  std::vector<RadiusRow> radii;
  std::vector<EstimatorRow> estimators;  ///< none: no model reads a velocity
};

std::string table(const Findings& findings);    ///< the front, the choice, rates, radii and estimators, as lines
std::string picture(const Findings& findings);  ///< SVG: cost against error of every candidate
std::string page(const Findings& findings);     ///< HTML with the picture inside
std::string json(const Findings& findings);

/// "teapot.tolerance 1e-06" or "the scene as it is".
std::string nameOf(const Findings& findings, const Candidate& candidate);
/// Why the chosen setting was chosen, in a sentence.
std::string reason(const Findings& findings);

}  // namespace hapticd::tune
