// SPDX-License-Identifier: MIT
#include "tune/page.hpp"

#include <fmt/format.h>

namespace hapticd::tune {
namespace {

/// Escapes text for HTML.
std::string escaped(const std::string& words) {
  std::string safe;
  for (const char c : words) safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

/// Returns one row of a table. @param tag td or th
std::string row(const std::vector<std::string>& cells, const char* tag = "td", const std::string& kind = "") {
  std::string text = kind.empty() ? "<tr>" : "<tr class=\"" + kind + "\">";
  for (const std::string& cell : cells) text += fmt::format("<{0}>{1}</{0}>", tag, escaped(cell));
  return text + "</tr>\n";
}

std::string head(const std::string& title, const std::vector<std::string>& cells) {
  return "<h2>" + title + "</h2>\n<table>" + row(cells, "th");
}

std::string frontTable(const Findings& findings) {
  const auto& all = findings.tuning.candidates;
  std::string text = head("Settings: no other is as accurate as one of the front and clearly cheaper",
                          {"setting", "no", "p50 ns", "p99 ns", "foot um", "normal deg", "force N", "on the front"});
  for (const Candidate* c : points(findings))
    text += row({nameOf(findings, *c), std::to_string(c->point),
                 fmt::format("{:.0f} to {:.0f}", c->cost.p50_low_ns, c->cost.p50_high_ns),
                 fmt::format("{:.0f}", c->cost.p99_ns), errorText(c->error), fmt::format("{:.3g}", c->error.normal_deg),
                 fmt::format("{:.3g}", c->error.force_n), c->on_front ? "yes" : "no"},
                "td",
                c == &all[findings.tuning.chosen] ? "chosen"
                : c == &all[0]                    ? "now"
                                                  : "");
  return text + "</table>\n<p>" + escaped(noise(findings)) + ".</p>\n";
}

std::string servoTables(const Findings& findings) {
  const auto kind = [](bool current) { return current ? "now" : ""; };
  std::string text = head("Servo rate", {"rate Hz", "load %", "force missed between ticks, against 10000 Hz: N"});
  for (const RateRow& r : findings.rates)
    text +=
        row({fmt::format("{:.0f}", r.rate), fmt::format("{:.2f}", r.load * 100), fmt::format("{:.3g}", r.hold_error_n)},
            "td", kind(r.current));
  text += "</table>\n" + head("Activation radius", {"radius m", "tick ns", "foot um"});
  for (const RadiusRow& r : findings.radii)
    text += row({fmt::format("{:.3g}", r.radius), fmt::format("{:.0f}", r.tick_ns),
                 r.error.untraced > 0 ? "untraced" : errorText(r.error)},
                "td", kind(r.current));
  text += "</table>\n";
  if (findings.estimators.empty()) return text;
  text += head("Velocity estimator", {"estimator", "tick ns", "force p99 N", "max N"});
  for (const EstimatorRow& r : findings.estimators)
    text += row({r.estimator, fmt::format("{:.0f}", r.tick_ns), fmt::format("{:.3g}", r.force_p99_n),
                 fmt::format("{:.3g}", r.force_max_n)},
                "td", kind(r.current));
  return text + "</table>\n";
}

}  // namespace

std::string page(const Findings& findings) {
  const auto& tuning = findings.tuning;
  const std::string stopped = stoppedWhy(findings), none = untouched(findings.tuning.touches);
  return fmt::format(
             "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>hapticd tune {0}</title>\n"
             "<style>body{{font:15px/1.5 Helvetica,Arial,sans-serif;max-width:60em;margin:2em auto;color:#222}}"
             "table{{border-collapse:collapse}}td,th{{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:right}}"
             "svg{{max-width:100%;height:auto}}"
             ".warning{{white-space:pre-line}}"
             "td:first-child,th:first-child{{text-align:left}}.chosen{{background:#fdecea}}.now{{background:#e8f0fa}}"
             "</style>\n"
             "<h1>Speed against accuracy: {0}</h1>\n<p>{1} settings measured over {2}. {5}Errors are the largest of "
             "the whole motion, against a converged reference: every tolerance at its smallest, every count at its "
             "largest, velocity from the motion itself.</p>\n<p><b>Chosen: {3}</b>: {4}.</p>\n{6}",
             escaped(findings.scene), tuning.candidates.size(), escaped(findings.motion),
             escaped(nameOf(findings, tuning.candidates[tuning.chosen])), escaped(reason(findings)),
             stopped.empty() ? "" : "It " + stopped + ". ",
             none.empty() ? "" : "<p class=\"warning\"><b>Warning:</b> " + escaped(none) + "</p>\n") +
         picture(findings) + frontTable(findings) + servoTables(findings) + "</html>\n";
}

}  // namespace hapticd::tune
