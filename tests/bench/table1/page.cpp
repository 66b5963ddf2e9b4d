// SPDX-License-Identifier: MIT
#include "page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "base/regular_file.hpp"
#include "record/plot.hpp"

namespace hapticd::table1 {

std::string lineOf(const Row& row) {
  const record::ContactStatistics& d = row.recording.depth;
  return fmt::format(
      "{:10} {}  {:7} samples  mean {:5.2f} ({:4.2f})  std {:5.2f} ({:4.2f})  max {:6.2f} ({:5.2f}) mm  buzz {:.3f} mm "
      "{}",
      row.subject, row.moving ? 2 : 1, d.contactTicks(), d.meanDepth() * 1e3, row.paper.mean, d.stdDepth() * 1e3,
      row.paper.std, d.maxDepth() * 1e3, row.paper.max, d.buzz() * 1e3, row.recording.fault);
}

Verdict judge(const std::vector<Row>& rows) {
  Verdict verdict;
  const auto demand = [&](bool good, const std::string& what) {
    if (!good) verdict.text += "MISSED: " + what + "\n", verdict.met = false;
  };
  for (const Row& row : rows) {
    const record::ContactStatistics& d = row.recording.depth;
    const std::string who = row.subject + (row.moving ? " 2" : " 1");
    verdict.mean += d.meanDepth() * 1e3 / static_cast<double>(rows.size());
    verdict.std += d.stdDepth() * 1e3 / static_cast<double>(rows.size());
    verdict.max += d.maxDepth() * 1e3 / static_cast<double>(rows.size());
    demand(d.contactTicks() >= 10000, who + ": at least 10,000 samples in contact");
    demand(d.meanDepth() < 3e-3, who + ": mean below 3 mm");
    demand(d.maxDepth() < 12e-3, who + ": maximum below 12 mm");
    demand(d.buzz() <= 0.12e-3, who + ": buzz at most 0.12 mm");
    demand(row.recording.fault.empty(), who + ": " + row.recording.fault);
  }
  demand(std::abs(verdict.mean - 1.63) <= 0.25 * 1.63, "average mean within a quarter of 1.63 mm");
  verdict.text += fmt::format("average: mean {:.2f} (1.63), std {:.2f} (1.17), max {:.2f} (7.07) mm", verdict.mean,
                              verdict.std, verdict.max);
  return verdict;
}

namespace {

std::vector<double> histogram(const Recording& recording, double bin, size_t bins) {
  std::vector<double> counts(bins, 0);
  const auto all = static_cast<double>(recording.depth.contactTicks());
  for (const Sample& sample : recording.samples)
    if (sample.contact) counts[std::min(bins - 1, static_cast<size_t>(sample.depth / bin))] += 100 / all;
  return counts;
}

std::string nameOf(const Row& row) {
  return fmt::format("{}, {}", row.subject, row.moving ? "moving" : "at rest");
}

void save(const record::Picture& picture, const std::string& file) {
  if (auto saved = writeWhole(file, picture.svg()); !saved) throw std::runtime_error(saved.error());
}

void drawHistograms(const Evaluation& e, const std::string& file) {
  constexpr double kBin = 0.25e-3;
  constexpr size_t kBins = 48;
  record::Picture picture("Depth in contact: ten rows of Table 1 (as Fig. 7 shows for the cylinder)", {420, 420});
  double most = 0;
  for (const Row& row : e.rows)
    for (const double share : histogram(row.recording, kBin, kBins)) most = std::max(most, share);
  for (const Row& row : e.rows) {
    record::Bars bars{row.moving ? "#d1495b" : "#1f5fa8", {}, histogram(row.recording, kBin, kBins)};
    for (size_t i = 0; i <= kBins; ++i) bars.edges.push_back(1e3 * kBin * static_cast<double>(i));
    record::Panel panel(nameOf(row), {"depth [mm]", 0, 12}, record::axisOver("% of samples", 0, most));
    panel.bars = {bars};
    panel.height = 110;
    picture.add(std::move(panel));
  }
  save(picture, file);
}

/// Returns the force over the travel of the tip along the detent curve, by Eq. 10. The travel of the tip is that of the
/// button plus the compression of the surface's spring.
record::Curve closedForm() {
  record::Curve curve{"two springs, closed form", "#c4c4c4", {}, {}, 6};
  const auto add = [&](double x2, double force) {
    curve.x.push_back(1e3 * (x2 + force / kSurface));
    curve.y.push_back(force);
  };
  for (const auto& [x2, force] : kDetent) add(x2, force);
  add(kDetent[3][0] + 1.5e-3, kDetent[3][1] + 1.5e-3 * kEndSlope);
  return curve;
}

/// Returns the axis that contains all values that `of` takes from these curves.
record::Axis axisOfAll(const std::string& label, const std::vector<record::Curve>& curves,
                       std::vector<double> record::Curve::* of) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const record::Curve& curve : curves)
    for (const double value : curve.*of) low = std::min(low, value), high = std::max(high, value);
  return record::axisOver(label, low, high);
}

void drawButton(const Evaluation& e, const std::string& file) {
  record::Curve sent{"force commanded", "#1f5fa8", {}, {}, 1.2},
      felt{"force from the load cells", "#d1495b", {}, {}, 0.6, true};
  // where the tip is slow, one point stands for many samples
  const auto add = [](record::Curve& to, double x, double y, double apart) {
    if (!to.x.empty() && std::hypot(x - to.x.back(), y - to.y.back()) < apart) return;
    to.x.push_back(x), to.y.push_back(y);
  };
  for (const Sample& s : e.pressed.samples) {
    add(sent, s.travel * 1e3, s.contact ? s.force : 0, 0.1);
    add(felt, s.travel * 1e3, s.felt, 0.2);
  }
  const std::vector<record::Curve> curves{closedForm(), sent, felt};  // each is drawn over those before it
  record::Picture picture("Force against travel of the push button, pressed slowly in and out (as Fig. 8)", {760});
  record::Panel panel("", axisOfAll("travel of the tip [mm]", curves, &record::Curve::x),
                      axisOfAll("force [N]", curves, &record::Curve::y), curves);
  panel.height = 290;
  picture.add(std::move(panel));
  save(picture, file);
}

void drawTrace(const Evaluation& e, const std::string& file) {
  record::Picture picture("Twelve seconds of tracing", {860});
  for (const size_t i : {size_t{0}, size_t{3}, size_t{5}, size_t{9}}) {
    if (i >= e.rows.size()) continue;
    const Row& row = e.rows[i];
    record::Curve depth{"", row.moving ? "#d1495b" : "#1f5fa8", {}, {}, 1.0};
    for (size_t k = 0; k < row.recording.samples.size(); k += 8) {
      const Sample& s = row.recording.samples[k];
      if (s.t < 6 || s.t > 18) continue;
      depth.x.push_back(s.t), depth.y.push_back(s.contact ? s.depth * 1e3 : std::nan(""));
    }
    record::Panel panel(nameOf(row), {"t [s]", 6, 18}, {"depth [mm]", 0, 8}, {depth});
    panel.height = 95;
    picture.add(std::move(panel));
  }
  save(picture, file);
}

std::string table(const Evaluation& e) {
  std::string text =
      "| model | test | samples | mean | paper | STD | paper | max | paper | buzz |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : e.rows) {
    const record::ContactStatistics& d = row.recording.depth;
    text += fmt::format("| {} | {} | {} | **{:.2f}** | {:.2f} | **{:.2f}** | {:.2f} | **{:.2f}** | {:.2f} | {:.3f} |\n",
                        row.subject, row.moving ? "2, moving" : "1, at rest", d.contactTicks(), d.meanDepth() * 1e3,
                        row.paper.mean, d.stdDepth() * 1e3, row.paper.std, d.maxDepth() * 1e3, row.paper.max,
                        d.buzz() * 1e3);
  }
  return text + fmt::format("| average | | | **{:.2f}** | 1.63 | **{:.2f}** | 1.17 | **{:.2f}** | 7.07 | |\n",
                            e.verdict.mean, e.verdict.std, e.verdict.max);
}

/// Lists the rows whose mean depth differs from the paper's by more than a quarter. The last column is the push that
/// gives the paper's mean depth, by the law of the wall F = 6 N sqrt(x / 1 mm).
std::string missesText(const Evaluation& e) {
  constexpr double kAllowed = 0.25;
  constexpr double kWall = 6;  // [N] force at the depth of 1 mm
  std::string text =
      "| row | mean against the paper | STD | max | push that the paper's mean asks for |\n|---|---|---|---|---|\n";
  for (const Row& row : e.rows) {
    const record::ContactStatistics& d = row.recording.depth;
    const auto off = [](double ours, double paper) { return 100 * (1e3 * ours / paper - 1); };
    if (std::abs(off(d.meanDepth(), row.paper.mean)) <= 100 * kAllowed) continue;
    text += fmt::format("| {}, {} | {:+.0f} % | {:+.0f} % | {:+.0f} % | {:.1f} N |\n", row.subject,
                        row.moving ? "moving" : "at rest", off(d.meanDepth(), row.paper.mean),
                        off(d.stdDepth(), row.paper.std), off(d.maxDepth(), row.paper.max),
                        row.subject == "button" ? kSurface * 1e-3 * row.paper.mean : kWall * std::sqrt(row.paper.mean));
  }
  return text;
}

std::string variationTable(const Evaluation& e) {
  std::string text = "| cylinder at rest | mean | STD | max | buzz |\n|---|---|---|---|---|\n";
  for (const Variation& v : e.variations)
    text += fmt::format("| {} | {:.2f} | {:.2f} | {:.2f} | {:.3f} |\n", v.what, v.depth.meanDepth() * 1e3,
                        v.depth.stdDepth() * 1e3, v.depth.maxDepth() * 1e3, v.depth.buzz() * 1e3);
  return text;
}

std::string protocolText(const Protocol& p) {
  return fmt::format(
      R"(- **From the paper**: 1500 Hz; Eq. 4 with n = 1/2 and 6000 N/m, read as 6 N at 1 mm (k x0 (x/x0)^n with x0 = 1 mm: in SI units
  as printed the mean row would need 242 N); velocity by Eq. 5 with n = {}; models of 40 kg, the button without mass and with
  linear springs (Eq. 10); the button's own resistance rises to 9 N, falls to 5 N and rises again (Fig. 6 has no numbers).
- **The arm** (`config/devices/simulated-sarcos.yaml`): eight joints, 10 to 30 um at the tip, one sample of delay,
  joint friction. Its masses were never published: 1.1 to 1.9 kg are felt at the tip. Assumption.
- **The hand**: 1 kg on {:g} N/m and 10 N s/m, pulled to a point behind the surface. The push is {:g} N on average and wanders by {:.0f} %
  (Ornstein-Uhlenbeck, {:g} Hz, at most {:g} standard deviations), with a tremor of {:.0f} % at {:g} Hz. Assumptions, but for one subject's
  grip in the literature (0.55 kg, 6.5 N s/m, 135 N/m).
- **The eye** is {:.0f} ms late: the hand follows where a moving model was.
- **The way**: strokes of about 0.1 m/s over models of 0.2 to 0.36 m. Every {:g} s the finger is lifted by {:.0f} mm and touches
  down again at {:g} m/s. It is lifted round the edges of the cube, and near edges and on the goblet's stem it pushes less: a point behind
  the surface that is nearer to another side would drag it there, as happened to an earlier operator of ours who cut the corner.
- **Moving models** (test 2): cube, cylinder and goblet {}; the pendulum swings from 0.15 rad.
- **Settled after first runs**, not before: the push, the speed of the touch and the spring; the table below shows what they change.
)",
      p.window, p.stiffness, p.force, 100 * p.spread, p.spread_rate, p.most, 100 * p.tremor, p.tremor_rate,
      1e3 * p.visual_delay, p.touch_every, 1e3 * p.lift, p.touch_speed, kMotionOfSolids);
}

std::string introduction() {
  return "# Table 1 of the NURBS paper, in simulation\n\n"
         "Made by `table1 --write` (in the build folder's `bench/`; a quarter of a minute of CPU, virtual time). The "
         "numbers are the same every\n"
         "time and on every x86-64 processor: it runs with `HAPTICD_INSTRUCTIONS=portable` and the daemon's own "
         "elementary functions. With\n"
         "other instructions (AVX2, AArch64) forces differ in their last bits; a touch that is off by so little goes "
         "another way, and the\n"
         "second decimals differ.\n\n"
         "Thompson, Nelson, Cohen and Hollerbach (1999) measured how deep a hand sinks into five models while it "
         "traces them with a\n"
         "Sarcos arm. Here the same daemon core, plugins and limits run against a simulated arm and a simulated "
         "operator. Depth in mm;\n"
         "buzz is the rms of the depth about its mean in windows of 20 ms, as `--report` gives it.\n\n";
}

std::string resultsText(const Evaluation& e) {
  return table(e) +
         "\nGoals, checked by `table1 --check` (a test): average mean within 25 % of 1.63 mm, every mean below 3 mm, "
         "every maximum\n"
         "below 12 mm, buzz at most 0.12 mm, at least 10,000 samples a row. " +
         (e.verdict.met ? "**All met.**\n" : "**Missed**:\n\n```\n" + e.verdict.text + "\n```\n") +
         "\n![histograms of depth](pictures/table1-histograms.svg)\n\n![depth over time](pictures/table1-trace.svg)\n\n"
         "![force against travel of the button](pictures/table1-button.svg)\n\n"
         "The load cells sit behind the joints' friction and before the arm's mass: their force is pinv(J^T) of the "
         "torques less the\n"
         "arm's weight, with the arm's inertia in it while it moves; the snap of the detent shows it.\n\n";
}

std::string missesSection(const Evaluation& e) {
  return "## Rows that miss the paper\n\n"
         "Means that are off by more than a quarter:\n\n" +
         missesText(e) +
         "\nWhy: the push sets the depth (F = 6 N (x / 1 mm)^1/2; of the button 6 N x / 1 mm), and the paper does not "
         "say how hard its operators "
         "pushed. Here one hand\n"
         "pushes alike in all rows, but less near edges and on the goblet's stem. The paper's own means differ by a "
         "factor of 4 with the same\n"
         "wall, and its moving tests by factors from 0.28 to 1.8 from those at rest. The last column is the steady "
         "push "
         "that would press as deep\n"
         "as the paper says. A push fitted to each row would hide that.\n\n";
}

std::string dependenceText(const Evaluation& e) {
  return "\n## What the figures depend on\n\n"
         "The mean is set by how hard the hand pushes and by the wall, hardly by the software; buzz tells "
         "implementations apart. A touch is\n"
         "a fast change of depth too, and counts as buzz in the window it falls into: hence its dependence on the "
         "touch.\n\n" +
         variationTable(e) +
         "\nThe paper says that the largest depth was \"on the average less than 7 mm\"; its own rows average 7.07 "
         "mm.\n"
         "Three human parameters against three numbers a row: the agreement shows that the system is plausible, not "
         "that it is the\n"
         "same.\n";
}

}  // namespace

void writePage(const Evaluation& e, const std::string& folder) {
  const std::filesystem::path pictures = std::filesystem::path(folder) / "pictures";
  std::filesystem::create_directories(pictures);
  drawHistograms(e, pictures / "table1-histograms.svg");
  drawButton(e, pictures / "table1-button.svg");
  drawTrace(e, pictures / "table1-trace.svg");
  std::ofstream out(std::filesystem::path(folder) / "table1.md");
  out << introduction() << resultsText(e) << missesSection(e) << "## Protocol: one for all rows\n\n"
      << protocolText(e.protocol) << dependenceText(e);
  if (!out.flush()) throw std::runtime_error(folder + "/table1.md: cannot be written");
}

}  // namespace hapticd::table1
