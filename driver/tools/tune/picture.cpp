// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "record/plot.hpp"
#include "tune/page.hpp"

namespace hapticd::tune {
namespace {

constexpr const char *kChosen = "#c0392b", *kCurrent = "#2962a3", *kFront = "#222", *kTried = "#bbb";

/// [um] Returns the error to draw; values below the rounding error are drawn at the rounding error.
double errorOf(const Candidate& c) {
  return std::max(c.error.geometry(), kErrorNoise) * 1e6;
}

record::NamedPoint pointOf(const Findings& findings, const Candidate& c) {
  const auto& all = findings.tuning.candidates;
  const bool chosen = &c == &all[findings.tuning.chosen], current = &c == &all[0];
  record::NamedPoint point;
  point.x = c.cost.p50_ns;
  point.x_low = c.cost.p50_low_ns, point.x_high = c.cost.p50_high_ns;
  point.y = errorOf(c);
  point.label = std::to_string(c.point);
  point.name = nameOf(findings, c) + (chosen ? " (chosen)" : "");
  point.colour = chosen ? kChosen : current ? kCurrent : kFront;
  return point;
}

}  // namespace

std::string picture(const Findings& findings) {
  double cheap = 1e300, dear = 0, fine = 1e300, coarse = 0;
  record::Curve tried{"another setting that was tried", kTried, {}, {}, 2.5, true};
  for (const Candidate& c : findings.tuning.candidates) {
    cheap = std::min(cheap, c.cost.p50_low_ns), dear = std::max(dear, c.cost.p50_high_ns);
    fine = std::min(fine, errorOf(c)), coarse = std::max(coarse, errorOf(c));
    if (c.point == 0) tried.x.push_back(c.cost.p50_ns), tried.y.push_back(errorOf(c));
  }
  record::Panel panel("Numbers are those of the table; lines are the intervals of the measured medians",
                      record::axisOver("median of a tick [ns]", cheap, dear, true),
                      record::axisOver(fmt::format("largest error of the foot point [um]; {:g} and below is rounding",
                                                   kErrorNoise * 1e6),
                                       fine, coarse, true));
  if (!tried.x.empty()) panel.curves = {std::move(tried)};
  for (const Candidate* c : points(findings)) panel.points.push_back(pointOf(findings, *c));
  panel.height = 320;
  record::Picture picture("Speed against accuracy: " + findings.scene, {860});
  picture.add(std::move(panel));
  return picture.svg();
}

}  // namespace hapticd::tune
