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
  std::string motion;  ///< source of the probe's motion
  std::vector<Knob> knobs;
  Goal goal;
  double limit_seconds = 0;  ///< time after which no more settings were tried
  Tuning tuning;
  std::vector<RateRow> rates;
  std::vector<RadiusRow> radii;
  std::vector<EstimatorRow> estimators;  ///< nothing if no model reads a velocity
};

/// Numbers the settings that tables and pictures name: those of the front from the cheapest on, then the scene as
/// written and the chosen one if they are not among them. Of equivalent settings one is enough.
void numberPoints(Findings& findings);

std::string table(const Findings& findings);    ///< the front, the choice, rates, radii and estimators, as lines
std::string picture(const Findings& findings);  ///< SVG: cost against error of every candidate
std::string page(const Findings& findings);     ///< HTML with the picture inside
std::string json(const Findings& findings);

/// The numbered settings in order.
std::vector<const Candidate*> points(const Findings& findings);
/// "teapot.tolerance 1e-06" or "the scene as written".
std::string nameOf(const Findings& findings, const Candidate& candidate);
/// A sentence that says why the chosen setting was chosen.
std::string reason(const Findings& findings);
/// "" or a sentence that says why not every setting was tried.
std::string stoppedWhy(const Findings& findings);
/// A sentence that says how much the times of one setting differed.
std::string noise(const Findings& findings);
/// "12.3" [um], or "lost" if the track was lost.
std::string errorText(const Difference& error);

}  // namespace hapticd::tune
