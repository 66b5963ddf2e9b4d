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
  double limit_seconds = 0;  ///< after which no more settings were tried
  Tuning tuning;
  std::vector<RateRow> rates;
  std::vector<RadiusRow> radii;
  std::vector<EstimatorRow> estimators;  ///< none: no model reads a velocity
};

/// Numbers the settings that tables and pictures name: those of the front from the cheapest on, then the scene as
/// written and the chosen one where they are not among them. Of settings that do the same, one is enough.
void numberPoints(Findings& findings);

std::string table(const Findings& findings);    ///< the front, the choice, rates, radii and estimators, as lines
std::string picture(const Findings& findings);  ///< SVG: cost against error of every candidate
std::string page(const Findings& findings);     ///< HTML with the picture inside
std::string json(const Findings& findings);

/// The numbered settings in their order.
std::vector<const Candidate*> points(const Findings& findings);
/// "teapot.tolerance 1e-06" or "the scene as written".
std::string nameOf(const Findings& findings, const Candidate& candidate);
/// Why the chosen setting was chosen, in a sentence.
std::string reason(const Findings& findings);
/// "" or why not every setting was tried, in a sentence.
std::string stoppedWhy(const Findings& findings);
/// How far times of one setting lay apart, in a sentence.
std::string noise(const Findings& findings);
/// "12.3" [um], or "lost" where the track was.
std::string errorText(const Difference& error);

}  // namespace hapticd::tune
