// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench.hpp"
#include "kernels/trace/tracer.hpp"

namespace hapticd::bench {
namespace {

using spline::SurfaceData;

constexpr int kRounds = 9;

/// Returns the time per tick [ns] of a tracer that traces the surfaces in `start`, activated as after a search.
double costOf(const trace::Model& model, const std::vector<trace::Near>& start,
              const std::vector<Eigen::Vector3d>& probe) {
  trace::Tracer tracer(model);
  Stretches cost;
  for (int round = 0; round < kRounds; ++round) {
    tracer.reset();
    for (const trace::Near& near : start) tracer.activate(near.surface, near.u, near.v, near.distance);
    cost.walk([&](std::size_t i) { keep(tracer.step(probe[i]).depth); });
  }
  return cost.mean();
}

std::vector<trace::Near> nearest(const trace::Model& model, const Eigen::Vector3d& p, std::size_t count) {
  std::vector<trace::Near> found(count);
  const auto all = static_cast<std::size_t>(model.nearby(p, 10, found.data(), count));
  found.resize(std::min(count, all));
  return found;
}

/// Returns the time per tick [ns] over `count` sheets that lie above each other. @param gap [m] distance between two
/// sheets
double costOfStack(int count, double gap) {
  const SurfaceData data = surfaces()[0];
  std::vector<SurfaceData> stack(static_cast<std::size_t>(count), data);
  for (int i = 0; i < count; ++i) {
    for (auto& point : stack[static_cast<std::size_t>(i)].points) point.z() += gap * i;
  }
  const trace::Model model(stack);
  const Path path = contactPath(data, kStep, kDepth, kTicks);
  return costOf(model, nearest(model, path.probe[0], stack.size()), path.probe);
}

/// Returns a walk in circles over the tiles around the middle of the sheet. It goes into contact and out of it.
std::vector<Eigen::Vector3d> circles() {
  constexpr double kRadius = 0.015;
  std::vector<Eigen::Vector3d> probe;
  for (int i = 0; i < kTicks; ++i) {
    const double angle = i * kStep / kRadius;
    const double x = kRadius * std::cos(angle) + 0.003, y = kRadius * std::sin(angle) + 0.004;
    probe.emplace_back(x, y, 0.004 * std::sin(40 * x) * std::cos(40 * y) + kDepth * std::sin(0.003 * i));
  }
  return probe;
}

double costOfTiles(int count) {
  const trace::Model model(tiles(8));
  const auto probe = circles();
  return costOf(model, nearest(model, probe[0], static_cast<std::size_t>(count)), probe);
}

double seconds(double nanoseconds) {
  return 1e-9 * nanoseconds;
}

}  // namespace

void printMany() {
  std::printf("\n## Several active surfaces [ns a tick / ns a surface / ns a further surface]\n\n");
  std::printf(
      "A surface is evaluated only in ticks in which it could hold the nearest foot: distances change by at most the\n"
      "path of the probe, and a box bounds them. Sheets %.1f mm apart are the worst case: many could, in every "
      "tick.\n\n",
      0.1);
  std::printf("| active | sheets 0.1 mm apart | sheets 10 mm apart | tiles of 20 mm |\n|---|---|---|---|\n");
  std::array<double, 3> one{};
  for (int count : {1, 2, 4, 8, 16, 32}) {
    const std::array costs{costOfStack(count, 1e-4), costOfStack(count, 1e-2), costOfTiles(count)};
    if (count == 1) one = costs;
    std::printf("| %d ", count);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      std::printf("| %.0f / %.1f ", costs[i], costs[i] / count);
      if (count > 1) std::printf("/ %.1f ", (costs[i] - one[i]) / (count - 1));
    }
    std::printf("|\n");
  }
}

void printScale() {
  constexpr std::size_t kActive = 32;
  std::printf("\n## Size of the model\n\nBicubic tiles of 20 mm, the nearest %zu of them active.\n\n", kActive);
  std::printf("| patches | tick ns | proximity query within 100 mm us | load s | MB |\n|---|---|---|---|---|\n");
  for (int side : {6, 10, 32, 100}) {
    const auto surfaces = tiles(side);
    std::unique_ptr<trace::Model> model;
    const double load = nanoseconds(1, [&] { model = std::make_unique<trace::Model>(surfaces); });
    const auto probe = circles();
    const double tick = costOf(*model, nearest(*model, probe[0], kActive), probe);
    std::vector<trace::Near> found(1000);
    double query = HUGE_VAL;
    for (int i = 0; i < kRounds; ++i)
      query = std::min(query, nanoseconds(1, [&] { keep(model->nearby(probe[0], 0.1, found.data(), found.size())); }));
    std::printf("| %d | %.0f | %.0f | %.2f | %.1f |\n", side * side, tick, 1e-3 * query, seconds(load),
                static_cast<double>(model->bytes()) / 1e6);
  }
}

}  // namespace hapticd::bench
