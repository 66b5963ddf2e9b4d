// SPDX-License-Identifier: MIT
/// Shows what was measured: as a table, a picture, an HTML page that needs no network, and JSON.
#pragma once
#include <string>
#include <vector>

#include "tune/search.hpp"
#include "tune/sweeps.hpp"

namespace hapticd::tune {

struct Findings {
  std::string scene;   ///< file of the scene
  std::string motion;  ///< source of the probe's motion
  std::vector<Knob> knobs;
  Goal goal;
  double limit_seconds = 0;  ///< time after which no more settings were tried
  Tuning tuning;
  std::vector<RateRow> rates;
  std::vector<RadiusRow> radii;
  std::vector<EstimatorRow> estimators;  ///< empty if no model reads a velocity
};

/// Numbers the settings that tables and pictures name. First come the settings of the front, from the cheapest on, then
/// the scene as written and the chosen setting if they are not on the front. Of equivalent settings only one gets a
/// number.
void numberPoints(Findings& findings);

std::string table(const Findings& findings);    ///< text with the front, the choice, rates, radii and estimators
std::string picture(const Findings& findings);  ///< SVG: cost against error of every candidate
std::string page(const Findings& findings);     ///< HTML with the picture inside
std::string json(const Findings& findings);

/// Returns the numbered settings in order.
std::vector<const Candidate*> points(const Findings& findings);
/// Returns the name of a setting, such as "teapot.tolerance 1e-06" or "the scene as written".
std::string nameOf(const Findings& findings, const Candidate& candidate);
/// Returns a sentence that says why the chosen setting was chosen.
std::string reason(const Findings& findings);
/// Returns a sentence that says why not every setting was tried, or "" if every one was.
std::string stoppedWhy(const Findings& findings);
/// Returns a sentence that says how much the times of one setting differed.
std::string noise(const Findings& findings);
/// Returns the error of the geometry in um as text, such as "12.3", or "lost" if the track was lost.
std::string errorText(const Difference& error);

}  // namespace hapticd::tune
