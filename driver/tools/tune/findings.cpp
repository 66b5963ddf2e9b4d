// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "tune/page.hpp"

namespace hapticd::tune {
namespace {

const Candidate& chosenOf(const Findings& findings) {
  return findings.tuning.candidates[findings.tuning.chosen];
}

bool cheaper(const Candidate* a, const Candidate* b) {
  return a->cost.p50_ns != b->cost.p50_ns ? a->cost.p50_ns < b->cost.p50_ns : a < b;
}

/// Returns the candidates of the Pareto front (of cost and error) that are shown, cheapest first. Of several that are
/// alike, the simplest is shown.
std::vector<Candidate*> front(Findings& findings) {
  std::vector<Candidate>& candidates = findings.tuning.candidates;
  std::vector<Candidate*> all;
  for (Candidate& candidate : candidates)
    if (candidate.on_front) all.push_back(&candidate);
  std::sort(all.begin(), all.end(), &cheaper);
  const Candidate &current = candidates[0], &chosen = chosenOf(findings);
  std::vector<Candidate*> shown;
  for (Candidate* c : all) {
    const bool alike_shown =
        std::any_of(shown.begin(), shown.end(), [&](const auto* other) { return alike(*c, *other); });
    const bool alike_wanted = (alike(*c, current) && current.on_front) || (alike(*c, chosen) && chosen.on_front);
    if (c == &current || c == &chosen)
      shown.push_back(c);
    else if (!alike_shown && !alike_wanted)
      shown.push_back(&candidates[simplest(candidates, static_cast<size_t>(c - candidates.data()))]);
  }
  std::sort(shown.begin(), shown.end(), &cheaper);
  return shown;
}

}  // namespace

void numberPoints(Findings& findings) {
  auto& all = findings.tuning.candidates;
  size_t count = 0;
  for (Candidate* c : front(findings)) c->point = ++count;
  for (Candidate* c : {&all[0], &all[findings.tuning.chosen]})
    if (c->point == 0) c->point = ++count;
}

std::vector<const Candidate*> points(const Findings& findings) {
  std::vector<const Candidate*> shown;
  for (const Candidate& c : findings.tuning.candidates)
    if (c.point > 0) shown.push_back(&c);
  std::sort(shown.begin(), shown.end(), [](const auto* a, const auto* b) { return a->point < b->point; });
  return shown;
}

std::string errorText(const Difference& error) {
  return error.untraced > 0 ? "lost" : fmt::format("{:.3g}", error.geometry() * 1e6);
}

std::string nameOf(const Findings& findings, const Candidate& candidate) {
  const std::string text = difference(findings.knobs, candidate.choice, currentOf(findings.knobs));
  return text.empty() ? "the scene as written" : text;
}

std::string stoppedWhy(const Findings& findings) {
  const Tuning& tuning = findings.tuning;
  if (tuning.complete) return "";
  const std::string tried = fmt::format("{} of {} settings were tried", tuning.candidates.size(), tuning.planned);
  if (!tuning.out_of_time) return "stopped early: " + tried;
  return fmt::format("stopped early, after the {:g} s of --limit-seconds: {}", findings.limit_seconds, tried);
}

std::string noise(const Findings& findings) {
  double widest = 0;
  for (const Candidate* c : points(findings))
    widest = std::max(widest, c->cost.p50_high_ns / std::max(c->cost.p50_low_ns, 1.0) - 1);
  return fmt::format(
      "noise: the medians of one setting differed by up to {:.0f} %; costs whose intervals overlap count as equal, and "
      "so do errors below {:g} um and {:g} N",
      100 * widest, kErrorNoise * 1e6, kForceNoise);
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
  const std::string limits = fmt::format("with errors of at most half of {:.3g} um and {:.3g} N",
                                         goal.tolerance_m * 1e6, goal.force_tolerance_n);
  if (findings.tuning.reached)
    return fmt::format("the cheapest of {} settings {}, so that other motions stay within the tolerances", count,
                       limits);
  return fmt::format("of {} settings there is none {}; this is the most accurate", count, limits);
}

}  // namespace hapticd::tune
