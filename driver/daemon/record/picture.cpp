// SPDX-License-Identifier: MIT
#include "record/picture.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/regular_file.hpp"
#include "record/svg.hpp"

namespace hapticd::record {

namespace {

constexpr double kWidth = 1000, kRowHeight = 170, kTop = 56, kLeft = 70, kPlotWidth = 640, kPlotHeight = 120;
constexpr double kHistogramLeft = kLeft + kPlotWidth + 60, kHistogramWidth = kWidth - kHistogramLeft - 30;
constexpr int kBins = 40;
constexpr const char *kGrid = "#ddd", *kInk = "#444";

/// One row of the picture: a quantity over time and its histogram.
struct Quantity {
  const char *name, *unit, *colour;
  std::function<double(const Sample&)> value;
  std::function<bool(const Sample&)> counts;  ///< in the histogram
};

struct Range {
  double low = 0, high = 1;
  double at(double y_top, double value) const {
    return y_top + kPlotHeight * (1 - (std::clamp(value, low, high) - low) / (high - low));
  }
};

/// The largest of 1, 2, 5 times a power of ten near a sixth of `span`.
double niceStep(double span) {
  const double raw = span / 6, power = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power) return factor * power;
  return 10 * power;
}

Range rangeOf(const Quantity& quantity, const std::vector<Sample>& samples) {
  double low = 0, high = 0;
  for (const Sample& sample : samples) {
    low = std::min(low, quantity.value(sample));
    high = std::max(high, quantity.value(sample));
  }
  if (!(high > low)) high = low + 1;
  const double step = niceStep(high - low);
  return {std::floor(low / step) * step, std::ceil(high / step) * step};
}

void drawAxes(Svg& svg, const Quantity& quantity, const Range& range, double y, double t0, double t1) {
  svg.label(kLeft, y - 8, fmt::format("{} [{}]", quantity.name, quantity.unit), "start", kInk, 13);
  const double step = niceStep(range.high - range.low);
  for (double v = range.low; v <= range.high + step / 2; v += step) {
    svg.line(kLeft, range.at(y, v), kLeft + kPlotWidth, range.at(y, v), std::abs(v) < step / 2 ? "#999" : kGrid);
    svg.label(kLeft - 6, range.at(y, v) + 4, fmt::format("{:g}", std::abs(v) < step / 2 ? 0.0 : v), "end");
  }
  const double dt = niceStep(t1 - t0);
  for (double t = std::ceil(t0 / dt) * dt; t <= t1 + 1e-9; t += dt)
    svg.label(kLeft + kPlotWidth * (t - t0) / (t1 - t0), y + kPlotHeight + 16, fmt::format("{:g} s", t), "middle");
}

void drawCurve(Svg& svg, const Quantity& quantity, const Range& range, const std::vector<Sample>& samples, double y) {
  const double t0 = samples.front().t, span = std::max(samples.back().t - t0, 1e-9);
  std::vector<double> xy;
  for (size_t i = 0; i < samples.size();) {
    const int column = static_cast<int>(kPlotWidth * (samples[i].t - t0) / span);
    double low = quantity.value(samples[i]), high = low;
    for (; i < samples.size() && static_cast<int>(kPlotWidth * (samples[i].t - t0) / span) == column; ++i) {
      low = std::min(low, quantity.value(samples[i]));
      high = std::max(high, quantity.value(samples[i]));
    }
    for (const double v : {low, high}) xy.insert(xy.end(), {kLeft + column, range.at(y, v)});
  }
  svg.curve(xy, quantity.colour, 1.1);
}

void drawHistogram(Svg& svg, const Quantity& quantity, const Range& range, const std::vector<Sample>& samples,
                   double y) {
  std::vector<double> bins(kBins, 0);
  double counted = 0;
  for (const Sample& sample : samples) {
    if (!quantity.counts(sample)) continue;
    const double share = (quantity.value(sample) - range.low) / (range.high - range.low);
    ++bins[static_cast<size_t>(std::clamp(static_cast<int>(share * kBins), 0, kBins - 1))];
    ++counted;
  }
  const double most = std::max(1.0, *std::max_element(bins.begin(), bins.end())), bar = kPlotHeight / kBins;
  for (int i = 0; i < kBins; ++i)
    svg.rectangle(kHistogramLeft, y + kPlotHeight - (i + 1) * bar,
                  kHistogramWidth * bins[static_cast<size_t>(i)] / most, bar * 0.9, quantity.colour);
  svg.line(kHistogramLeft, y, kHistogramLeft, y + kPlotHeight, "#999");
  svg.label(kHistogramLeft, y + kPlotHeight + 16, fmt::format("{:.0f} ticks", counted));
}

}  // namespace

Result<void> drawRun(const RunReport& report, const std::vector<Sample>& samples, const std::string& file,
                     bool positions) {
  if (samples.empty()) return Error{file + ": nothing to draw: the run had no tick"};
  const auto always = [](const Sample&) { return true; };
  const auto in_contact = [](const Sample& s) { return s.depth_m > 0; };
  std::vector<Quantity> quantities = {
      {"penetration depth (negative: distance)", "mm", "#1b6ca8",
       [](const Sample& s) { return std::max(s.depth_m * 1e3, -10.0); }, in_contact},
      {"force on the hand", "N", "#b5432a", [](const Sample& s) { return s.force_n; }, in_contact},
      {report.virtual_time ? "compute time" : "lateness", "us", "#3a7d44",
       [&](const Sample& s) { return report.virtual_time ? s.compute_us : s.lateness_us; }, always}};
  constexpr const char* kCoordinates[] = {"x of the tip", "y of the tip", "z of the tip"};
  for (size_t i = 0; i < 3 && positions; ++i)
    quantities.push_back(
        {kCoordinates[i], "mm", "#6a4c93", [i](const Sample& s) { return s.position_m[i] * 1e3; }, always});
  Svg svg(kWidth, kTop + static_cast<double>(quantities.size()) * kRowHeight + 10);
  svg.label(kLeft, 24,
            fmt::format("{}: {:.1f} Hz held, {} overruns, {:.1f} s", report.scene, report.rate_hz, report.overruns,
                        report.seconds),
            "start", "#222", 15);
  double y = kTop + 10;
  for (const Quantity& quantity : quantities) {
    const Range range = rangeOf(quantity, samples);
    drawAxes(svg, quantity, range, y, samples.front().t, std::max(samples.back().t, samples.front().t + 1e-3));
    drawCurve(svg, quantity, range, samples, y);
    drawHistogram(svg, quantity, range, samples, y);
    y += kRowHeight;
  }
  return writeWhole(file, svg.finished());
}

}  // namespace hapticd::record
