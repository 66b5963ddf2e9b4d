// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "tune/page.hpp"

namespace hapticd::tune {
namespace {

std::string rowText(const Findings& findings, const Candidate& c) {
  const auto& all = findings.tuning.candidates;
  const char chosen = &c == &all[findings.tuning.chosen] ? '>' : ' ', current = &c == &all[0] ? '*' : ' ';
  const std::string p50 = fmt::format("{:.0f}-{:.0f}", c.cost.p50_low_ns, c.cost.p50_high_ns);
  return fmt::format("{:>3}{}{} {:>13} {:>9.0f} {:>10} {:>10.3g} {:>10.3g} {:>7.0f}  {}\n", c.point, chosen, current,
                     p50, c.cost.p99_ns, errorText(c.error), c.error.normal_deg, c.error.force_n,
                     static_cast<double>(c.cost.bytes) / 1024, nameOf(findings, c));
}

std::string frontText(const Findings& findings) {
  std::string text =
      "\nno other setting is as accurate as one of these and clearly cheaper (> chosen, * the scene as written):\n"
      " no          p50 ns    p99 ns    foot um normal deg    force N      kB  setting\n";
  std::string beaten;
  for (const Candidate* c : points(findings)) (c->on_front ? text : beaten) += rowText(findings, *c);
  if (!beaten.empty())
    text += "\nfor each of these, another is as accurate and cheaper, or as cheap and more accurate:\n" + beaten;
  return text + "\n" + noise(findings) +
         "\nthe times are those of ticks that follow each other at once; "
         "a run sleeps between its ticks, so its caches are colder and its steps take longer\n";
}

std::string servoText(const Findings& findings) {
  std::string text =
      "\n   rate Hz      load    hold N   (load: share of a processor; hold: p99 of the difference between the force "
      "held for a tick and that at 10000 Hz)\n";
  for (const RateRow& row : findings.rates)
    text += fmt::format("{} {:>8.0f} {:>8.2f} % {:>8.3g}\n", row.current ? '*' : ' ', row.rate, row.load * 100,
                        row.hold_error_n);
  text +=
      "\n    radius m   tick ns    foot um   activation radius (errors against the widest one; untraced: "
      "a surface within 10 mm of the tip)\n";
  for (const RadiusRow& row : findings.radii)
    text += fmt::format("{} {:>9.3g} {:>9.0f} {:>10}\n", row.current ? '*' : ' ', row.radius, row.tick_ns,
                        row.error.untraced > 0 ? "untraced" : errorText(row.error));
  if (findings.estimators.empty()) return text;
  text += "\n    tick ns force p99 N     max N  velocity estimator (errors against the true velocity)\n";
  for (const EstimatorRow& row : findings.estimators)
    text += fmt::format("{} {:>9.0f} {:>11.3g} {:>9.3g}  {}\n", row.current ? '*' : ' ', row.tick_ns, row.force_p99_n,
                        row.force_max_n, row.estimator);
  return text;
}

}  // namespace

std::string table(const Findings& findings) {
  const auto& tried = findings.tuning.candidates;
  std::string text = fmt::format("{} settings measured over {}\n", tried.size(), findings.motion);
  if (const std::string why = stoppedWhy(findings); !why.empty()) text += why + "\n";
  if (const std::string none = untouched(findings.tuning.touches); !none.empty()) text += "warning: " + none + "\n";
  text += frontText(findings);
  if (std::any_of(tried.begin(), tried.end(), [](const Candidate& c) { return c.error.ambiguous > 0; }))
    text +=
        "\nin some ticks two places were equally near to the probe; there only the errors of the depth and of the size "
        "of the force count\n";
  text += "\nchosen: " + nameOf(findings, tried[findings.tuning.chosen]) + "\n  " + reason(findings) + "\n";
  return text + servoText(findings);
}

}  // namespace hapticd::tune
