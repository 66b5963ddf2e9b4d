// SPDX-License-Identifier: MIT
#include "record/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "base/regular_file.hpp"
#include "record/plot.hpp"

namespace hapticd::record {

namespace {

/// [px] width of a plot over time, and of a histogram; height of both
constexpr double kOver = 640, kBeside = 300, kHeight = 120;
constexpr size_t kBins = 40;
constexpr const char *kDepth = "#1b6ca8", *kForce = "#b5432a", *kTime = "#3a7d44", *kPlace = "#6a4c93", *kMark = "#777";

/// One row of the picture: a quantity over time and its histogram.
struct Quantity {
  std::string title, unit, colour;
  std::function<double(const Sample&)> value;
  std::function<bool(const Sample&)> counts;  ///< true for samples that count in the histogram
  std::string counted;                        ///< a text such as "% of the ticks in contact"
  bool logarithmic = false;
  double least = -HUGE_VAL;  ///< smaller values are drawn at the bottom edge
};

/// Returns an axis from the smallest to the largest finite value, or from 0 to 1 if there are none. @param counted true
/// to use only the values in the histogram
Axis axisOf(const Quantity& q, const std::vector<Sample>& samples, bool counted) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Sample& sample : samples) {
    const double value = q.value(sample);
    if (!std::isfinite(value) || (counted && !q.counts(sample))) continue;
    low = std::min(low, std::max(value, q.least)), high = std::max(high, value);
  }
  if (!(high >= low) || (low == 0 && high == 0)) low = 0, high = 1;  // if all values are 0, they give no scale
  return axisOver(fmt::format("[{}]", q.unit), q.logarithmic ? std::max(low, 0.1) : low, high, q.logarithmic);
}

Curve curveOf(const std::string& name, const std::string& colour, const std::vector<Sample>& samples,
              const std::function<double(const Sample&)>& value) {
  Curve curve{name, colour, {}, {}, 1.1};
  for (const Sample& sample : samples) curve.x.push_back(sample.t), curve.y.push_back(value(sample));
  return curve;
}

Panel panelOf(const Quantity& q, const std::vector<Sample>& samples, const Axis& time) {
  Panel panel(q.title, time, axisOf(q, samples, false));
  panel.curves = {curveOf("", q.colour, samples, q.value)};
  panel.height = kHeight;
  return panel;
}

Panel histogramOf(const Quantity& q, const std::vector<Sample>& samples) {
  Axis x = axisOf(q, samples, true);
  x.label = fmt::format("{} [{}]", q.title, q.unit);
  Bars bars{q.colour, {}, std::vector<double>(kBins, 0)};
  double counted = 0;
  for (const Sample& sample : samples) {
    const double value = q.value(sample);
    if (!q.counts(sample) || !std::isfinite(value)) continue;
    const double bin = std::floor(x.share(value) * kBins);
    ++bars.counts[static_cast<size_t>(std::clamp(bin, 0.0, kBins - 1.0))];
    ++counted;
  }
  for (size_t i = 0; i <= kBins; ++i) bars.edges.push_back(x.at(static_cast<double>(i) / kBins));
  for (double& count : bars.counts) count *= 100 / std::max(counted, 1.0);
  const double most = *std::max_element(bars.counts.begin(), bars.counts.end());
  Panel panel(fmt::format("distribution of {:.0f} ticks", counted), x, axisOver(q.counted, 0, std::max(most, 1.0)));
  panel.bars = {std::move(bars)};
  panel.height = kHeight;
  return panel;
}

/// Returns the intervals of time in which `name` returns the same words, except "". Intervals less than a pixel apart
/// are joined.
std::vector<Span> spansOf(const std::vector<Sample>& samples, const std::function<std::string(const Sample&)>& name) {
  std::vector<Span> spans;
  const double pixel = (samples.back().t - samples.front().t) / kOver;
  std::string now;
  for (size_t i = 0; i < samples.size(); ++i) {
    const std::string next = name(samples[i]);
    const bool goes_on = !spans.empty() && spans.back().name == next && samples[i].t - spans.back().to <= pixel;
    if (next != now && !next.empty() && !goes_on) spans.push_back({samples[i].t, samples[i].t, next, ""});
    now = next;
    if (!now.empty()) spans.back().to = samples[std::min(i + 1, samples.size() - 1)].t;
  }
  return spans;
}

std::vector<Span> modelSpans(const std::vector<Sample>& samples, const RunNotes& notes) {
  const auto touched = [&](const Sample& s) {
    const auto model = static_cast<size_t>(s.model);
    return s.depth_m > 0 && s.model >= 0 && model < notes.models.size() ? notes.models[model] : std::string();
  };
  std::vector<Span> spans = spansOf(samples, touched);
  for (Span& span : spans) {
    const auto place = std::find(notes.models.begin(), notes.models.end(), span.name) - notes.models.begin();
    span.colour = colourOf(static_cast<size_t>(place) + 2);
  }
  return spans;
}

/// Returns the intervals of time in which the limits reduced the force of the models by more than 1 %.
std::vector<Span> limitSpans(const std::vector<Sample>& samples) {
  std::vector<Span> spans = spansOf(samples, [](const Sample& s) {
    return s.asked_n - s.force_n > std::max(0.01, 0.01 * s.asked_n) ? std::string("made smaller by limits") : "";
  });
  for (Span& span : spans) span.colour = "#e08a1e";
  return spans;
}

/// Returns marks at the moments of the notes, at the beginning of each fault, and where programs marked the run: at
/// most 12 marks. The end of a run is not a fault.
std::vector<Mark> momentsOf(const std::vector<Sample>& samples, const RunNotes& notes) {
  constexpr size_t kMost = 12;
  constexpr uint32_t kStopped = 8;
  std::vector<Mark> marks;
  for (const auto& [t, what] : notes.moments)
    if (t >= samples.front().t && t <= samples.back().t && marks.size() < kMost) marks.push_back({t, what});
  uint32_t now = 0;
  for (const Sample& s : samples) {
    if (s.fault != now && s.fault != 0 && s.fault != kStopped && marks.size() < kMost)
      marks.push_back({s.t, nameOfFault(s.fault)});
    now = s.fault;
  }
  for (const auto& [t, text] : notes.marks)
    if (t >= samples.front().t && t <= samples.back().t && marks.size() < kMost) marks.push_back({t, text, kMark});
  return marks;
}

/// Returns the smallest depth [mm] that is drawn: distances outside are drawn up to three times the largest depth.
/// Otherwise, if the hand is far away, every contact would look flat. Without a contact all distances are drawn.
double leastDepth(const std::vector<Sample>& samples) {
  constexpr double kShallow = 0.5e-3;  // [m]
  double deepest = 0;
  for (const Sample& s : samples)
    if (std::isfinite(s.depth_m)) deepest = std::max(deepest, s.depth_m);
  return deepest > 0 ? -3e3 * std::max(deepest, kShallow) : -HUGE_VAL;
}

std::vector<Quantity> quantitiesOf(const RunReport& report, const std::vector<Sample>& samples, bool positions) {
  const auto always = [](const Sample&) { return true; };
  // As in the report, ticks with a fault do not count as contact: the force is zero then, also at the end of a run.
  const auto in_contact = [](const Sample& s) { return s.depth_m > 0 && s.fault == 0; };
  const auto with_force = [](const Sample& s) { return s.force_n > 0 && s.fault == 0; };  // a program may push, too
  const bool simulated = report.virtual_time;
  std::vector<Quantity> all = {{"penetration depth", "mm", kDepth, [](const Sample& s) { return s.depth_m * 1e3; },
                                in_contact, "% of the ticks in contact", false, leastDepth(samples)},
                               {"force on the hand", "N", kForce, [](const Sample& s) { return s.force_n; }, with_force,
                                "% of the ticks with a force"},
                               {simulated ? "compute time" : "lateness", "us", kTime,
                                [simulated](const Sample& s) { return simulated ? s.compute_us : s.lateness_us; },
                                always, "% of the ticks", true}};
  constexpr const char* kCoordinates[] = {"x of the tip", "y of the tip", "z of the tip"};
  for (size_t i = 0; i < 3 && positions; ++i)
    all.push_back({kCoordinates[i], "mm", kPlace, [i](const Sample& s) { return s.position_m[i] * 1e3; }, always,
                   "% of the ticks"});
  return all;
}

/// Says what a negative depth means: without this note, a curve at the bottom edge would look like a tip at rest.
std::string distanceNote(double low, const std::vector<Sample>& samples) {
  const auto below = [low](const Sample& s) { return s.depth_m * 1e3 < low; };
  if (std::none_of(samples.begin(), samples.end(), [](const Sample& s) { return s.depth_m > 0; }))
    return " (no contact: distance from the nearest model)";
  if (std::none_of(samples.begin(), samples.end(), below)) return " (negative: distance from the nearest model)";
  return fmt::format(" (negative: distance; more than {:g} mm drawn at the bottom edge)", -low);
}

/// Adds to the panel of the forces: the force that the models asked for, the times in which limits reduced it, and
/// limits.force.
void addAsked(Panel& panel, const std::vector<Sample>& samples, const RunNotes& notes) {
  const auto asked = [](const Sample& s) { return s.asked_n; };
  if (std::any_of(samples.begin(), samples.end(), [](const Sample& s) { return std::isfinite(s.asked_n); }))
    panel.curves.insert(panel.curves.begin(), curveOf("asked for by the models", "#b9b9b9", samples, asked));
  panel.curves.back().name = "sent to the arm";
  panel.spans = limitSpans(samples);
  const double limit = notes.force_limit_n;
  if (!std::isfinite(limit) || limit <= 0 || limit > 3 * panel.y.high) return;
  panel.y = axisOver(panel.y.label, panel.y.low, std::max(panel.y.high, limit));
  panel.bounds = {{limit, fmt::format("limits.force: {:g} N", limit)}};
}

/// Adds a row for a hinge or a slider. Its places are drawn as samples of their own, because they have ticks of their
/// own.
void addJoint(Picture& picture, const JointTrack& joint, const Axis& time) {
  std::vector<Sample> places(joint.places.size());
  for (size_t i = 0; i < places.size(); ++i) std::tie(places[i].t, places[i].position_m[0]) = joint.places[i];
  const auto value = [](const Sample& s) { return s.position_m[0]; };
  const auto always = [](const Sample&) { return true; };
  const Quantity q{joint.title, joint.unit, kPlace, value, always, "% of the ticks"};
  Panel panel = panelOf(q, places, time);
  for (const double stop : joint.stops)
    panel.bounds.push_back({stop, fmt::format("end stop: {:.4g} {}", stop, joint.unit)});
  picture.add(std::move(panel));
  picture.add(histogramOf(q, places));
}

std::string titleOf(const RunReport& report, double first, double last) {
  const bool whole = last - first > 0.98 * report.seconds;
  const std::string part = whole ? "" : fmt::format("{:.1f} to {:.1f} s of ", first, last);
  std::string text = fmt::format("{}: {}{:.1f} s at {:.1f} Hz", report.scene, part, report.seconds, report.rate_hz);
  if (report.overruns > 0) text += fmt::format(", {} overruns", report.overruns);
  return text;
}

}  // namespace

std::string nameOfFault(uint32_t fault) {
  constexpr const char* kNames[] = {"",
                                    "not finite",
                                    "device lost",
                                    "device at fault",
                                    "stale samples",
                                    "too fast",
                                    "too late",
                                    "not calibrated",
                                    "stopped",
                                    "stuck",
                                    "overheated",
                                    "jumped",
                                    "orientation not of length 1"};
  return fault < std::size(kNames) ? kNames[fault] : fmt::format("fault {}", fault);
}

Result<void> drawRun(const RunReport& report, const std::vector<Sample>& samples, const RunNotes& notes,
                     const std::string& file) {
  if (samples.empty()) return Error{file + ": nothing to draw: the run had no tick"};
  const double first = samples.front().t, last = std::max(samples.back().t, first + 1e-3);
  const std::string arm = notes.arm.empty() ? "" : ", " + notes.arm;
  Picture picture(titleOf(report, first, last) + arm, {kOver, kBeside});
  for (const Quantity& q : quantitiesOf(report, samples, notes.positions)) {
    Panel panel = panelOf(q, samples, {"time [s]", first, last});
    panel.moments = momentsOf(samples, notes);
    if (q.colour != kDepth)  // the texts of programs are read once, above the depth
      for (Mark& mark : panel.moments)
        if (mark.colour == kMark) mark.name.clear();
    Panel beside = histogramOf(q, samples);
    if (q.colour == kDepth) {
      const bool any =
          std::any_of(samples.begin(), samples.end(), [](const Sample& s) { return std::isfinite(s.depth_m); });
      panel.title += any ? distanceNote(panel.y.low, samples) : " (none: no model was near enough to be traced)";
      panel.spans = modelSpans(samples, notes);
    }
    if (q.colour == kForce) addAsked(panel, samples, notes);
    picture.add(std::move(panel));
    picture.add(std::move(beside));
  }
  for (const JointTrack& joint : notes.joints) addJoint(picture, joint, {"time [s]", first, last});
  return writeWhole(file, picture.svg());
}

}  // namespace hapticd::record
