// SPDX-License-Identifier: MIT
/// zwidth: computes the largest stiffness and damping that can be rendered, depending on rate, window, delay and
/// resolution, and compares them with the theoretical bounds. It prints tables. With --write it writes
/// driver/docs/reports/zwidth.md and its picture.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "base/regular_file.hpp"
#include "bounds.hpp"
#include "record/plot.hpp"
#include "wall_loop.hpp"

namespace {

using namespace hapticd::zwidth;
using hapticd::record::Curve;
using hapticd::record::Picture;

constexpr double kInNewtonPerMm = 1e-3;
const std::string& colour(size_t i) {
  return hapticd::record::colourOf(i);
}

/// A line for the theory, and dots for the results of the simulation.
struct Pair {
  Curve theory, found;
  Pair(const std::string& name, const std::string& ink)
      : theory{name, ink, {}, {}}, found{"", ink, {}, {}, 2.2, true} {}
  void add(double x, double bound, double simulated) {
    theory.x.push_back(x), theory.y.push_back(bound * kInNewtonPerMm);
    found.x.push_back(x), found.y.push_back(simulated * kInNewtonPerMm);
  }
};

std::vector<Curve> curvesOf(const std::vector<Pair>& pairs) {
  std::vector<Curve> curves;
  for (const Pair& pair : pairs) curves.push_back(pair.theory);
  for (const Pair& pair : pairs) curves.push_back(pair.found);
  return curves;
}

/// Collects the rows of the page.
struct Page {
  std::string text;
  void row(const std::string& line) { text += line + "\n"; }
};

void againstRate(Picture& picture, Page& page) {
  std::vector<Pair> pairs;
  page.row("\n## Against the rate\n\nDevice of b = 0.1 N s/m, wall without damping; K in N/mm.\n");
  page.row(
      "| rate [Hz] | bound 2b/T | found, worst hand | device of 75 g alone | the same, n = 15 with the best damping "
      "|\n|---|---|---|---|---|");
  Pair worst("2b/T: no passive hand makes it oscillate", colour(0));
  Curve alone{"a device of 75 g alone, n = 15, best B", colour(1), {}, {}};
  for (const double rate : {250.0, 500.0, 1000.0, 1500.0, 2000.0, 3000.0, 5000.0, 10000.0, 20000.0}) {
    Wall wall;
    wall.period = 1 / rate;
    const Body device;
    const double bound = maxStiffness(wall, device);
    const double found = stableStiffnessWorstHand(wall, device);
    const double lonely = stableStiffness(wall, device);
    double best = 0;
    wall.window = 15;
    for (double B = 0.01; B < 100; B *= 1.3) {
      wall.damping = B;
      best = std::max(best, stableStiffness(wall, device));
    }
    worst.add(rate, bound, found);
    alone.x.push_back(rate), alone.y.push_back(best * kInNewtonPerMm);
    page.row(fmt::format("| {:.0f} | {:.3f} | {:.3f} | {:.3f} | {:.2f} |", rate, bound * 1e-3, found * 1e-3,
                         lonely * 1e-3, best * 1e-3));
  }
  pairs.push_back(worst);
  std::vector<Curve> curves = curvesOf(pairs);
  curves.push_back(alone);
  picture.add(hapticd::record::Panel("Stiffness against rate", {"rate [Hz]", 200, 20000, true},
                                     {"K [N/mm]", 0.01, 1000, true}, curves));
}

void againstDamping(Picture& picture, Page& page) {
  page.row(
      "\n## Stiffness against damping, for windows of Eq. 5\n\n1 kHz, device of b = 1 N s/m; K in N/mm: bound / found "
      "with the worst hand.\n");
  page.row("| B [N s/m] | n = 1 | n = 3 | n = 5 | n = 15 | n = 50 |\n|---|---|---|---|---|---|");
  std::vector<Pair> pairs;
  const std::vector<int> windows{1, 3, 5, 15, 50};
  for (size_t i = 0; i < windows.size(); ++i) pairs.emplace_back(fmt::format("n = {}", windows[i]), colour(i));
  Body device;
  device.damping = 1;
  for (double B = 0; B <= 4.5; B += 0.5) {
    std::string line = fmt::format("| {:g} |", B);
    for (size_t i = 0; i < windows.size(); ++i) {
      Wall wall;
      wall.damping = B, wall.window = windows[i];
      const double bound = maxStiffness(wall, device);
      // skipped, because a state of fifty samples takes long
      const bool slow = wall.window > 15 && std::fmod(B, 1) != 0;
      const double found = bound > 0 && !slow ? stableStiffnessWorstHand(wall, device) : std::nan("");
      pairs[i].add(B, bound, found);
      line += std::isnan(found) ? fmt::format(" {:.3f} |", bound * 1e-3)
                                : fmt::format(" {:.3f} / {:.3f} |", bound * 1e-3, found * 1e-3);
    }
    page.row(line);
  }
  picture.add(hapticd::record::Panel("Stiffness against damping (Z-width), 1 kHz, b = 1 N s/m", {"B [N s/m]", 0, 4.5},
                                     {"K [N/mm]", 0, 2.2}, curvesOf(pairs)));
}

void againstDelay(Picture& picture, Page& page) {
  page.row("\n## Against delay\n\nDevice of b = 0.1 N s/m, wall without damping; K in N/mm.\n");
  page.row("| delay [samples] | bound b/((d + 1/2) T), 1 kHz | found | bound, 5 kHz | found |\n|---|---|---|---|---|");
  std::vector<Pair> pairs{{"1 kHz", colour(0)}, {"5 kHz", colour(1)}};
  for (int delay = 0; delay <= 6; ++delay) {
    std::string line = fmt::format("| {} |", delay);
    for (size_t i = 0; i < 2; ++i) {
      Wall wall;
      wall.period = i == 0 ? 1e-3 : 2e-4, wall.delay = delay;
      const Body device;
      const double bound = maxStiffness(wall, device);
      const double found = stableStiffnessWorstHand(wall, device);
      pairs[i].add(delay, bound, found);
      line += fmt::format(" {:.4f} | {:.4f} |", bound * 1e-3, found * 1e-3);
    }
    page.row(line);
  }
  picture.add(hapticd::record::Panel("Stiffness against delay", {"delay [samples]", 0, 6}, {"K [N/mm]", 0.01, 2, true},
                                     curvesOf(pairs)));
}

void againstResolution(Picture& picture, Page& page) {
  page.row(
      "\n## Against the resolution of the position\n\n1 kHz, Coulomb friction c beside b; K in N/mm: min(2b/T, "
      "2c/step) and the stiffness from which a zigzag draws energy.\n");
  page.row(
      "| step [um] | b 0.5, c 0.01 | found | b 0.5, c 0.04 | found | b 0.1, c 0.04 | found "
      "|\n|---|---|---|---|---|---|---|");
  const double devices[3][2] = {{0.5, 0.01}, {0.5, 0.04}, {0.1, 0.04}};
  std::vector<Pair> pairs;
  for (size_t i = 0; i < 3; ++i)
    pairs.emplace_back(fmt::format("b = {}, c = {} N", devices[i][0], devices[i][1]), colour(i));
  for (const double step : {3e-6, 10e-6, 20e-6, 30e-6, 50e-6, 100e-6, 200e-6, 400e-6}) {
    std::string line = fmt::format("| {:.0f} |", step * 1e6);
    for (size_t i = 0; i < 3; ++i) {
      Wall wall;
      wall.resolution = step;
      Body device;
      device.damping = devices[i][0], device.friction = devices[i][1];
      const double bound = maxStiffnessQuantised(wall, device);
      const double found = passiveStiffness(wall, device);
      pairs[i].add(step * 1e6, bound, found);
      line += fmt::format(" {:.3f} | {:.3f} |", bound * 1e-3, found * 1e-3);
    }
    page.row(line);
  }
  picture.add(hapticd::record::Panel("Stiffness against resolution, 1 kHz", {"step of the position [um]", 3, 400, true},
                                     {"K [N/mm]", 0.01, 3, true}, curvesOf(pairs)));
}

void againstWindow(Picture& picture, Page& page) {
  page.row(
      "\n## A device alone, against the window\n\nK in N/mm with the best damping B: what one device holds, not what "
      "every hand leaves stable.\n");
  page.row(
      "| n | 75 g, b 0.1, 1 kHz | 75 g, b 0.1, 1500 Hz | 75 g, b 0.1, 10 kHz | 3 kg, b 5, 1500 Hz | 3 kg, 1500 Hz, one "
      "sample late |\n|---|---|---|---|---|---|");
  std::vector<Curve> curves;
  const struct {
    const char* name;
    double mass, damping, rate;
    int delay;
  } cases[] = {{"75 g, 1 kHz", 0.075, 0.1, 1000, 0},
               {"75 g, 1500 Hz", 0.075, 0.1, 1500, 0},
               {"75 g, 10 kHz", 0.075, 0.1, 10000, 0},
               {"3 kg, 1500 Hz", 3, 5, 1500, 0},
               {"3 kg, 1500 Hz, 1 late", 3, 5, 1500, 1}};
  for (size_t i = 0; i < std::size(cases); ++i) curves.push_back({cases[i].name, colour(i), {}, {}});
  for (const int window : {1, 2, 3, 5, 8, 15, 30, 50}) {
    std::string line = fmt::format("| {} |", window);
    for (size_t i = 0; i < std::size(cases); ++i) {
      Wall wall;
      wall.period = 1 / cases[i].rate, wall.window = window, wall.delay = cases[i].delay;
      Body body;
      body.mass = cases[i].mass, body.damping = cases[i].damping;
      double best = 0;
      for (double B = 1e-3 * body.mass * cases[i].rate; B < 2 * body.mass * cases[i].rate; B *= 1.2) {
        wall.damping = B;
        best = std::max(best, stableStiffness(wall, body));
      }
      curves[i].x.push_back(window), curves[i].y.push_back(best * 1e-3);
      line += fmt::format(" {:.1f} |", best * 1e-3);
    }
    page.row(line);
  }
  picture.add(
      {"A device alone, best damping", {"window n [samples]", 1, 50, true}, {"K [N/mm]", 0.3, 10000, true}, curves});
}

void bounce(Picture& picture, Page& page) {
  page.row(
      "\n## Bounce of the undamped wall\n\n1500 N/m, 75 g: speed after over speed before, the worst phase of "
      "sampling.\n");
  page.row("| rate [Hz] | exp(pi w T / 4) | found |\n|---|---|---|");
  Curve theory{"exp(pi w T/4)", colour(0), {}, {}}, found{"found", colour(0), {}, {}, 2.2, true};
  for (const double rate : {500.0, 1000.0, 1500.0, 3000.0, 5000.0, 10000.0}) {
    Wall wall;
    wall.stiffness = 1500, wall.period = 1 / rate;
    const double e = std::exp(M_PI / 4 * std::sqrt(wall.stiffness / 0.075) * wall.period),
                 simulated = restitution(wall, 0.075);
    theory.x.push_back(rate), theory.y.push_back(e);
    found.x.push_back(rate), found.y.push_back(simulated);
    page.row(fmt::format("| {:.0f} | {:.4f} | {:.4f} |", rate, e, simulated));
  }
  picture.add(hapticd::record::Panel("Bounce of the undamped sampled wall", {"rate [Hz]", 500, 10000, true},
                                     {"speed after / before", 1, 1.3}, {theory, found}));
}

int draw(bool write) {
  Picture picture("How stiff a sampled wall may be: theory (lines) and simulation (dots)", {520, 520});
  Page page;
  againstRate(picture, page);
  againstDamping(picture, page);
  againstDelay(picture, page);
  againstResolution(picture, page);
  againstWindow(picture, page);
  bounce(picture, page);
  fmt::print("{}", page.text);
  if (!write) return 0;
  const std::filesystem::path folder = HAPTICD_SOURCE_DIR "/driver/docs/reports";
  std::filesystem::create_directories(folder / "pictures");
  const auto saved = hapticd::writeWhole(folder / "pictures/zwidth.svg", picture.svg());
  if (!saved) throw std::runtime_error(saved.error());
  std::ofstream out(folder / "zwidth.md");
  out << "# How stiff a wall may be\n\nMade by `zwidth --write` (in the build folder's `bench/`).\n\n"
         "A wall that is computed in ticks is felt one half to one and a half periods late, and gives back more energy "
         "than it took.\n"
         "The device's own friction must take the difference. Lines are theory, dots what simulations found:\n\n"
         "- **Bound**: b > K T/2 + c_n B for a window of n samples, with c_1 = 1, c_3 = 0.438, c_15 = 0.259 (Colgate "
         "and Schenkel 1997, with\n"
         "  the window of Eq. 5 of Thompson et al. put in); with delay or both, the numeric maximum over frequency. "
         "Below it no passive\n"
         "  hand makes the wall oscillate. The functions are in `tests/bench/zwidth/bounds.hpp`.\n"
         "- **Found, worst hand**: the smallest stiffness at which some hand of mass and spring, without friction, "
         "makes the loop grow: the\n"
         "  eigenvalues of the exact sampled loop. The bound is as tight as these hands come near it.\n"
         "- **Resolution**: a motion that turns round at the edge of an encoder count draws energy from K > 2c/step; a "
         "fast one from\n"
         "  K > 2b/T (Abbott and Okamura 2005). Found by the energy of zigzags through the production wall law.\n"
         "- **A device alone** holds far more than the bound: the bound is for the worst hand. Damping, a short window "
         "and a high rate help;\n"
         "  every sample of delay costs.\n\n"
         "![six views of the largest stiffness](pictures/zwidth.svg)\n"
      << page.text;
  if (!out.flush()) throw std::runtime_error("zwidth.md: cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return draw(argc > 1 && std::strcmp(argv[1], "--write") == 0);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
