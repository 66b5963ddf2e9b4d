// SPDX-License-Identifier: MIT
/// Measures the scenes of the paper's Table 1, with 1 to 35 bodies, in the whole servo core.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "bench.hpp"
#include "kernels/medial/body.hpp"
#include "scene_world.hpp"

namespace hapticd::bench_mat {
namespace {

using Eigen::Vector3d;
namespace fs = std::filesystem;

constexpr std::size_t kThirtyFive = 5;  ///< index of the row with 35 bodies

struct Kind {
  int rows, columns, count;
};
struct Row {
  std::vector<Kind> kinds;
  std::string paper_preprocessing, paper_memory;
  double paper_us;  ///< [us] time per tick in the haptics loop, from the rate and the share of run time in the paper
};

/// Returns scenes with as many bodies and points as the paper's rows. The shapes of the paper's bodies are not known.
std::vector<Row> rows() {
  return {{{{7, 7, 1}}, "2 s", "400 KB", 204},
          {{{7, 15, 1}}, "3 s", "1.0 MB", 266},
          {{{7, 7, 3}, {6, 11, 1}}, "6 s", "1.8 MB", 253},
          {{{5, 6, 9}, {3, 13, 1}}, "9 s", "2.1 MB", 276},
          {{{4, 7, 16}, {1, 17, 1}}, "25 s", "3.0 MB", 308},
          {{{5, 5, 34}, {7, 11, 1}}, "56 s", "4.1 MB", 367},
          {{{5, 5, 1000}}, "", "", 0}};
}

medial::BodyData bodyOf(const Kind& kind) {
  medial::BodyData data;
  data.grid.count = {kind.rows, kind.columns};
  for (int i = 0; i < kind.rows; ++i) {
    for (int j = 0; j < kind.columns; ++j) {
      const double s = i / std::max(kind.rows - 1.0, 1.0) - .5, t = j / std::max(kind.columns - 1.0, 1.0) - .5;
      data.grid.points.emplace_back(.03 * t, .03 * s, .01 * s * t);
      data.grid.radius.push_back(.008 + .004 * std::cos(2 * s) * std::cos(2 * t));
    }
  }
  const std::size_t total = data.grid.points.size();
  data.stiffness.assign(total, 400);
  data.damping.assign(total, .05);
  data.mass.assign(total, .05);
  return data;
}

void writeModel(const medial::BodyData& data, const fs::path& file) {
  std::string points, radius;
  const auto columns = static_cast<std::size_t>(data.grid.count[1]);
  for (std::size_t i = 0; i < data.grid.points.size(); ++i) {
    const char* open = i % columns == 0 ? (i > 0 ? "], [" : "[") : ", ";
    const Vector3d& p = data.grid.points[i];
    points += fmt::format("{}[{:.9f}, {:.9f}, {:.9f}]", open, p.x(), p.y(), p.z());
    radius += fmt::format("{}{:.9f}", open, data.grid.radius[i]);
  }
  std::ofstream(file) << fmt::format(
      "format: hapticd-model/1\nmedial:\n  points: [{}]]\n  radius: [{}]]\n  stiffness: {}\n  damping: {}\n  mass: "
      "{}\n",
      points, radius, data.stiffness[0], data.damping[0], data.mass[0]);
}

/// Returns the place of a body in a square grid with `side` bodies per row. Body 0 is in a corner, so that it has
/// equally many neighbours in every scene.
Vector3d placeOf(int body, int side) {
  return {.07 * (body % side - side / 2), .07 * (body / side - side / 2), 0};
}

int sideOf(const Row& row) {
  int bodies = 0;
  for (const Kind& kind : row.kinds) bodies += kind.count;
  return bodies < 49 ? 7 : 32;
}

struct Setting {
  const char* radius;  ///< activation radius [m]
  const char* dynamics;
};

std::unique_ptr<servo::World> build(const Row& row, const Setting& setting, const fs::path& folder, double& seconds) {
  std::string models;
  int body = 0;
  const int side = sideOf(row);
  for (std::size_t k = 0; k < row.kinds.size(); ++k) {
    writeModel(bodyOf(row.kinds[k]), folder / fmt::format("kind{}.yaml", k));
    for (int i = 0; i < row.kinds[k].count; ++i, ++body) {
      const Vector3d at = placeOf(body, side);
      models += fmt::format(
          "  - name: body{}\n    plugin: mat_deformable\n    pose: {{position: [{}, {}, {}]}}\n"
          "    parameters: {{geometry: kind{}.yaml, dynamics: {}}}\n",
          body, at.x(), at.y(), at.z(), k, setting.dynamics);
    }
  }
  return buildWorld(
      fmt::format("hapticd: 1\nservo: {{rate: 1000, activation_radius: {}, hysteresis: 0.05}}\nmodels:\n{}",
                  setting.radius, models),
      folder, seconds);
}

/// Returns the median time [us] of a tick while the probe strokes body 0 at 0.1 m/s and 3 mm deep.
double stroke(Hand& hand, int side, int ticks) {
  return hand
      .ticks(ticks,
             [side](int i) -> Vector3d {
               return placeOf(0, side) + Vector3d(.008 * std::sin(.0125 * i), .008 * std::cos(.0125 * i), .008);
             })
      .at(.5);
}

/// Presses every body deeply at all of its parts, so that all nodes move.
void wakeAll(Hand& hand, int side, int bodies) {
  for (int body = 0; body < bodies; ++body)
    for (int i = 0; i < 81; ++i)
      hand.tick(placeOf(body, side) + Vector3d(.015 * (i % 9 - 4) / 4, .015 * (i / 9 - 4) / 4, .004));
}

/// Returns the times of a tick [us] when all bodies are traced, however far away, and when in addition all of them are
/// awake.
std::string wide(const Row& row, const char* dynamics, const fs::path& folder) {
  int bodies = 0;
  for (const Kind& kind : row.kinds) bodies += kind.count;
  if (bodies > 100) return "|";
  double unused = 0;
  const int side = sideOf(row);
  const auto world = build(row, {"2", dynamics}, folder, unused);
  Hand hand(*world);
  stroke(hand, side, 500);
  const double followed = stroke(hand, side, 2000);
  wakeAll(hand, side, bodies);
  return fmt::format("{:.1f} | {:.1f}", followed, stroke(hand, side, 400));
}

std::string line(const Row& row, const fs::path& folder) {
  int bodies = 0, points = 0;
  double fit = 0;
  for (const Kind& kind : row.kinds) {
    bodies += kind.count;
    points += kind.count * kind.rows * kind.columns;
    const medial::BodyData data = bodyOf(kind);
    fit += kind.count * medianTime(5, 3, [&](int) { medial::Body body(data, {}); });
  }
  double load = 0, unused = 0;
  const int side = sideOf(row);
  const auto world = build(row, {"0.10", "on"}, folder, load);
  const double memory = static_cast<double>(world->lockedBytes()) / 1024;
  Hand hand(*world);
  stroke(hand, side, 500);
  const double one = stroke(hand, side, 2000);
  const auto still = build(row, {"0.10", "off"}, folder, unused);
  Hand still_hand(*still);
  stroke(still_hand, side, 500);
  const double without = stroke(still_hand, side, 2000);
  const auto felt = build(row, {"0.10", "felt"}, folder, unused);
  Hand felt_hand(*felt);
  stroke(felt_hand, side, 500);
  const double felt_one = stroke(felt_hand, side, 2000);
  return fmt::format(
      "| {} | {} | {} | {:.1f} ms | {:.0f} ms | {} | {:.0f} kB | {} | {:.1f} | {:.1f} | {} | {:.1f} | {} |\n", bodies,
      points, row.paper_preprocessing, 1e3 * fit, 1e3 * load, row.paper_memory, memory,
      row.paper_us > 0 ? fmt::format("{:.0f}", row.paper_us) : "", without, one, wide(row, "on", folder), felt_one,
      wide(row, "felt", folder));
}

fs::path newFolder() {
  fs::path folder = fs::temp_directory_path() / fmt::format("hapticd-bench-mat-{}", ::getpid());
  fs::create_directories(folder);
  return folder;
}

}  // namespace

void strokeGarden(const char* dynamics, bool awake, int ticks) {
  const fs::path folder = newFolder();
  const Row row = rows()[kThirtyFive];
  double unused = 0;
  const auto world = build(row, {awake ? "2" : "0.10", dynamics}, folder, unused);
  Hand hand(*world);
  stroke(hand, sideOf(row), 500);
  if (awake) wakeAll(hand, sideOf(row), 35);
  const double median = stroke(hand, sideOf(row), ticks);
  fs::remove_all(folder);
  fmt::print("{} {}: {} ticks, median {:.2f} us\n", dynamics, awake ? "awake" : "one", ticks, median);
}

std::string gardenTable() {
  const fs::path folder = newFolder();
  std::string text =
      "## The paper's scenes\n\nCorso et al. ran on a Pentium III of 700 MHz; their haptic time is the rate and the "
      "share of run time of their Table 1. Times are medians of a whole servo tick [us], the probe stroking one body "
      "3 mm deep at 0.1 m/s. *followed*: an activation radius of 2 m, so that every body is traced, however far. "
      "*awake*: so, and every body has been poked and still swings. The first three are with dynamics that are seen "
      "alone, "
      "the others with dynamics that are felt.\n\n"
      "| bodies | points | paper: preprocessing | fit | load and check | paper: memory | memory | paper: haptic time | "
      "no dynamics | one touched | followed | all awake | felt: one touched | followed | all awake "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows()) text += line(row, folder);
  fs::remove_all(folder);
  return text + "\n";
}

}  // namespace hapticd::bench_mat
