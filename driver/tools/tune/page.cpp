// SPDX-License-Identifier: MIT
#include "tune/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "record/svg.hpp"

namespace hapticd::tune {
namespace {

constexpr double kNoError = 1e-15;  ///< [m] smaller errors are drawn here

/// The candidates worth having, cheapest first.
std::vector<const Candidate*> front(const Findings& findings) {
  std::vector<const Candidate*> all;
  for (const Candidate& candidate : findings.tuning.candidates)
    if (candidate.on_front) all.push_back(&candidate);
  std::sort(all.begin(), all.end(), [](const auto* a, const auto* b) { return a->cost.p50_ns < b->cost.p50_ns; });
  // Of settings that do the same, such as the iterations of a method that is not in use, one is enough.
  const Candidate *current = &findings.tuning.candidates[0],
                  *chosen = &findings.tuning.candidates[findings.tuning.chosen];
  std::vector<const Candidate*> shown;
  for (const Candidate* c : all) {
    const bool alike_shown =
        std::any_of(shown.begin(), shown.end(), [&](const auto* other) { return alike(*c, *other); });
    const bool wanted = c == current || c == chosen;
    const bool alike_wanted = (alike(*c, *current) && current->on_front) || alike(*c, *chosen);
    if (wanted || (!alike_shown && !alike_wanted)) shown.push_back(c);
  }
  return shown;
}

std::string errorText(const Candidate& c) {
  return c.error.untraced > 0 ? "lost" : fmt::format("{:.3g}", c.error.geometry() * 1e6);
}

std::string rowText(const Findings& findings, const Candidate& c, char mark) {
  return fmt::format("{} {:>9.0f} {:>9.0f} {:>10} {:>10.3g} {:>10.3g} {:>9.0f}  {}\n", mark, c.cost.p50_ns,
                     c.cost.p99_ns, errorText(c), c.error.normal_deg, c.error.force_n,
                     static_cast<double>(c.cost.bytes) / 1024, nameOf(findings, c));
}

const Candidate& chosenOf(const Findings& findings) {
  return findings.tuning.candidates[findings.tuning.chosen];
}

/// Where a value stands between the ends of a logarithmic axis.
double share(double value, double low, double high) {
  return (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low));
}

std::string htmlRow(const Findings& findings, const Candidate& c, const char* kind) {
  return fmt::format(
      "<tr class=\"{}\"><td>{}</td><td>{:.0f}</td><td>{:.0f}</td><td>{}</td><td>{:.3g}</td><td>{:.3g}</td></tr>\n",
      kind, nameOf(findings, c), c.cost.p50_ns, c.cost.p99_ns, errorText(c), c.error.normal_deg, c.error.force_n);
}

}  // namespace

std::string nameOf(const Findings& findings, const Candidate& candidate) {
  const std::string text = difference(findings.knobs, candidate.choice, currentOf(findings.knobs));
  return text.empty() ? "the scene as written" : text;
}

std::string reason(const Findings& findings) {
  const Candidate& chosen = chosenOf(findings);
  const Goal& goal = findings.goal;
  const size_t count = findings.tuning.candidates.size();
  if (goal.budget_ns) {
    const std::string budget = fmt::format("{:.3g} us", *goal.budget_ns * 1e-3);
    const std::string p99 = fmt::format("{:.3g} us", chosen.cost.p99_ns * 1e-3);
    if (findings.tuning.reached)
      return fmt::format("the most accurate of {} settings whose p99 is at most {}: {}", count, budget, p99);
    return fmt::format("none of {} settings has a p99 of at most {}; this is the cheapest: {}", count, budget, p99);
  }
  const std::string limits =
      fmt::format("within half of {:.3g} um and {:.3g} N", goal.tolerance_m * 1e6, goal.force_tolerance_n);
  if (findings.tuning.reached)
    return fmt::format("the cheapest of {} settings {}, so that other motions stay within them", count, limits);
  return fmt::format("none of {} settings is {}; this is the most accurate", count, limits);
}

std::string table(const Findings& findings) {
  std::string text = fmt::format("{} settings measured over {}\n", findings.tuning.candidates.size(), findings.motion);
  if (!findings.tuning.complete) text += "stopped early: not every setting was tried\n";
  text += "\nno other setting is both cheaper and more accurate than these (> chosen, * the scene as written):\n";
  text += "     p50 ns    p99 ns    foot um normal deg    force N    kB  setting\n";
  for (const Candidate* c : front(findings))
    text += rowText(findings, *c, c == &chosenOf(findings) ? '>' : c == &findings.tuning.candidates[0] ? '*' : ' ');
  const Candidate& current = findings.tuning.candidates[0];
  if (!current.on_front)
    text += "\nthe scene as written; another setting is both cheaper and more accurate:\n" +
            rowText(findings, current, '*');
  const auto& tried = findings.tuning.candidates;
  if (std::any_of(tried.begin(), tried.end(), [](const Candidate& c) { return c.error.ambiguous > 0; }))
    text +=
        "\nin some ticks two places were equally near to the probe; there the errors of depth and size of force "
        "count\n";
  text += "\nchosen: " + nameOf(findings, chosenOf(findings)) + "\n  " + reason(findings) + "\n";
  text +=
      "\n   rate Hz      load    hold N   (load: share of a processor; hold: change of the force between two ticks, "
      "p99)\n";
  for (const RateRow& row : findings.rates)
    text += fmt::format("{} {:>8.0f} {:>8.2f} % {:>8.3g}\n", row.current ? '*' : ' ', row.rate, row.load * 100,
                        row.hold_error_n);
  text += "\n    radius m   tick ns    foot um   activation radius (of what is nearest, against the widest)\n";
  for (const RadiusRow& row : findings.radii)
    text += fmt::format("{} {:>9.3g} {:>9.0f} {:>10}\n", row.current ? '*' : ' ', row.radius, row.tick_ns,
                        row.error.untraced > 0 ? "untraced" : fmt::format("{:.3g}", row.error.geometry() * 1e6));
  if (findings.estimators.empty()) return text;
  text += "\n    tick ns force p99 N     max N  velocity estimator (against the velocity that the motion has)\n";
  for (const EstimatorRow& row : findings.estimators)
    text += fmt::format("{} {:>9.0f} {:>11.3g} {:>9.3g}  {}\n", row.current ? '*' : ' ', row.tick_ns, row.force_p99_n,
                        row.force_max_n, row.estimator);
  return text;
}

std::string picture(const Findings& findings) {
  constexpr double kWidth = 860, kHeight = 420, kLeft = 80, kRight = 820, kTop = 40, kBottom = 360;
  double cheap = 1e300, dear = 0, fine = 1e300, coarse = 0;
  for (const Candidate& c : findings.tuning.candidates) {
    const double error = std::max(c.error.geometry(), kNoError);
    cheap = std::min(cheap, c.cost.p50_ns / 1.2);
    dear = std::max(dear, c.cost.p50_ns * 1.2);
    fine = std::min(fine, error / 3);
    coarse = std::max(coarse, error * 3);
  }
  const auto x = [&](double ns) { return kLeft + (kRight - kLeft) * share(ns, cheap, dear); };
  const auto y = [&](double m) { return kBottom - (kBottom - kTop) * share(std::max(m, kNoError), fine, coarse); };
  record::Svg svg(kWidth, kHeight);
  svg.label(kLeft, 22, "error of the foot point against cost, every setting tried", "start", "#222", 15);
  for (double power = std::ceil(std::log10(fine)); power <= std::log10(coarse); power += 1) {
    const double value = std::pow(10, power);
    svg.line(kLeft, y(value), kRight, y(value), "#ddd");
    svg.label(kLeft - 6, y(value) + 4, fmt::format("{:g} um", value * 1e6), "end");
  }
  for (const double factor : {1.0, 2.0, 5.0})
    for (double power = std::floor(std::log10(cheap)); power <= std::log10(dear); power += 1) {
      const double value = factor * std::pow(10, power);
      if (value < cheap || value > dear) continue;
      svg.line(x(value), kTop, x(value), kBottom, "#eee");
      svg.label(x(value), kBottom + 18, fmt::format("{:g} ns", value), "middle");
    }
  svg.label((kLeft + kRight) / 2, kBottom + 40,
            "median of a tick; black: the front, red: chosen, blue: the scene as written", "middle");
  const auto mark = [&](const Candidate& c, double half, const char* colour) {
    svg.rectangle(x(c.cost.p50_ns) - half, y(c.error.geometry()) - half, 2 * half, 2 * half, colour);
  };
  const auto& tried = findings.tuning.candidates;
  for (const Candidate& c : tried)
    if (!c.on_front) mark(c, 2.5, "#bbb");
  for (const Candidate& c : tried)
    if (c.on_front) mark(c, 4, "#222");
  mark(tried[0], 6, "#2962a3");  // larger than the chosen one, so that both are seen where they are the same
  mark(chosenOf(findings), 4, "#c0392b");
  return svg.finished();
}

std::string page(const Findings& findings) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>hapticd tune {0}</title>\n"
      "<style>body{{font:15px/1.5 Helvetica,Arial,sans-serif;max-width:60em;margin:2em auto;color:#222}}"
      "table{{border-collapse:collapse}}td,th{{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:right}}"
      "td:first-child,th:first-child{{text-align:left}}.chosen{{background:#fdecea}}.now{{background:#e8f0fa}}</"
      "style>\n"
      "<h1>Speed against accuracy: {0}</h1>\n<p>{1} settings measured over {2}. Errors are the largest of the whole "
      "motion, against a converged reference: every tolerance at its smallest, every count at its largest, velocity "
      "from "
      "the motion itself.</p>\n<p><b>Chosen: {3}</b>: {4}.</p>\n",
      findings.scene, findings.tuning.candidates.size(), findings.motion, nameOf(findings, chosenOf(findings)),
      reason(findings));
  text += picture(findings);
  text +=
      "<h2>No other setting is both cheaper and more accurate</h2>\n<table><tr><th>setting</th><th>p50 ns</th><th>p99 "
      "ns</th><th>foot um</th><th>normal deg</th><th>force N</th></tr>\n";
  for (const Candidate* c : front(findings))
    text += htmlRow(findings, *c,
                    c == &chosenOf(findings)              ? "chosen"
                    : c == &findings.tuning.candidates[0] ? "now"
                                                          : "");
  text +=
      "</table>\n<h2>Servo rate</h2>\n<table><tr><th>rate Hz</th><th>load %</th><th>force missed between ticks "
      "N</th></tr>\n";
  for (const RateRow& row : findings.rates)
    text += fmt::format("<tr class=\"{}\"><td>{:.0f}</td><td>{:.2f}</td><td>{:.3g}</td></tr>\n",
                        row.current ? "now" : "", row.rate, row.load * 100, row.hold_error_n);
  text += "</table>\n<h2>Activation radius</h2>\n<table><tr><th>radius m</th><th>tick ns</th><th>foot um</th></tr>\n";
  for (const RadiusRow& row : findings.radii)
    text += fmt::format("<tr class=\"{}\"><td>{:.3g}</td><td>{:.0f}</td><td>{}</td></tr>\n", row.current ? "now" : "",
                        row.radius, row.tick_ns,
                        row.error.untraced > 0 ? "untraced" : fmt::format("{:.3g}", row.error.geometry() * 1e6));
  text += "</table>\n";
  if (!findings.estimators.empty())
    text +=
        "<h2>Velocity estimator</h2>\n<table><tr><th>estimator</th><th>tick ns</th><th>force p99 N</th><th>max "
        "N</th></tr>\n";
  for (const EstimatorRow& row : findings.estimators)
    text += fmt::format("<tr class=\"{}\"><td>{}</td><td>{:.0f}</td><td>{:.3g}</td><td>{:.3g}</td></tr>\n",
                        row.current ? "now" : "", row.estimator, row.tick_ns, row.force_p99_n, row.force_max_n);
  if (!findings.estimators.empty()) text += "</table>\n";
  return text + "</html>\n";
}

std::string json(const Findings& findings) {
  using Json = nlohmann::ordered_json;
  Json all = Json::array();
  for (const Candidate& c : findings.tuning.candidates) {
    Json settings = Json::object();
    for (size_t i = 0; i < findings.knobs.size(); ++i)
      settings[findings.knobs[i].name()] = findings.knobs[i].values[c.choice[i]];
    all.push_back({{"settings", settings},
                   {"p50_ns", c.cost.p50_ns},
                   {"p99_ns", c.cost.p99_ns},
                   {"bytes", c.cost.bytes},
                   {"foot_um", c.error.foot_m * 1e6},
                   {"depth_um", c.error.depth_m * 1e6},
                   {"normal_deg", c.error.normal_deg},
                   {"force_n", c.error.force_n},
                   {"untraced", c.error.untraced},
                   {"ambiguous", c.error.ambiguous},
                   {"on_front", c.on_front}});
  }
  Json rates = Json::array();
  for (const RateRow& row : findings.rates)
    rates.push_back({{"rate_hz", row.rate}, {"load", row.load}, {"hold_error_n", row.hold_error_n}});
  Json radii = Json::array();
  for (const RadiusRow& row : findings.radii)
    radii.push_back({{"radius_m", row.radius},
                     {"tick_ns", row.tick_ns},
                     {"foot_um", row.error.foot_m * 1e6},
                     {"untraced", row.error.untraced}});
  Json estimators = Json::array();
  for (const EstimatorRow& row : findings.estimators)
    estimators.push_back({{"estimator", row.estimator},
                          {"tick_ns", row.tick_ns},
                          {"force_p99_n", row.force_p99_n},
                          {"force_max_n", row.force_max_n}});
  return Json{{"scene", findings.scene},
              {"chosen", findings.tuning.chosen},
              {"reached", findings.tuning.reached},
              {"complete", findings.tuning.complete},
              {"reason", reason(findings)},
              {"candidates", all},
              {"rates", rates},
              {"radii", radii},
              {"estimators", estimators}}
             .dump(2) +
         "\n";
}

}  // namespace hapticd::tune
