// SPDX-License-Identifier: MIT
/// Measures the volume of pressed bodies, with and without VolumeKeeper.
#include "kernels/medial/volume.hpp"

#include <fmt/format.h>

#include "bench.hpp"
#include "kernels/medial/body.hpp"
#include "kernels/medial/contour.hpp"

namespace hapticd::bench_mat {
namespace {

using Eigen::Vector3d;

medial::BodyData sheetOf(int n, double side, double radius) {
  medial::BodyData data;
  data.grid.count = {n, n};
  for (int i = 0; i < n * n; ++i) {
    data.grid.points.emplace_back(side * (i / n) / (n - 1), side * (i % n) / (n - 1), 0);
    data.grid.radius.push_back(radius);
  }
  const std::size_t total = data.grid.points.size();
  data.stiffness.assign(total, 400);
  data.damping.assign(total, .8);
  data.mass.assign(total, .008);
  return data;
}

struct Result {
  double change = 0, ns = 0, median_bytes = 0;
};

Result press(const medial::BodyData& data, double radius, double side, double error, bool keep) {
  medial::Body body(data, {});
  const medial::Contour fine(body.skeleton(), 2e-3 * radius), hull(body.skeleton(), error * radius);
  medial::VolumeKeeper keeper(hull, radius);
  medial::SkeletonFoot foot = body.skeleton().search({.45 * side, .55 * side, .4 * radius}, {});
  const medial::Press contact{foot.u, foot.v, foot.normal, .6 * radius, 0};  // 30 % of the thickness
  const auto tick = [&](int) {
    body.deformation().advance(1e-3);
    body.deformation().press({&contact, 1});
    if (keep) keeper.step(body.deformation());
  };
  for (int i = 0; i < 500; ++i) tick(i);
  std::vector<float> xyz = fine.atRest();
  const double rest = fine.volume(xyz);
  fine.write([&](std::size_t i) -> Eigen::Vector4f { return body.deformation().displacement(i).cast<float>(); },
             xyz.data(), fine.vertexCount(), static_cast<float>(body.deformation().bulge()));
  return {fine.volume(xyz) / rest - 1, 1e9 * leastTime(11, 100, tick), double(keeper.bytes() + hull.bytes())};
}

}  // namespace

std::string volumeTable() {
  std::string text =
      "## Volume\n\nA press of 30 % of the thickness, held for half a second; volume by an integral over a contour of "
      "0.2 % chord error. The plugin takes the finest of the hulls here.\n\n"
      "| body | volume | hull: chord error / radius | change of the volume | advance, press and keeper, a tick | "
      "memory of the "
      "hull |\n|---|---|---|---|---|---|\n";
  struct Kind {
    const char* name;
    int n;
    double side, radius;
  };
  for (const Kind& kind : {Kind{"pebble, 5 x 5, 20 mm, radius 12 mm", 5, .02, .012},
                           Kind{"slab, 7 x 7, 100 mm, radius 10 mm", 7, .1, .01}}) {
    const medial::BodyData data = sheetOf(kind.n, kind.side, kind.radius);
    const Result off = press(data, kind.radius, kind.side, .05, false);
    text += fmt::format("| {} | off | | {:+.2f} % | {:.0f} ns | |\n", kind.name, 100 * off.change, off.ns);
    for (const double error : {.05, .02, .01, .005}) {
      const Result on = press(data, kind.radius, kind.side, error, true);
      text += fmt::format("| | on | {} | {:+.3f} % | {:.0f} ns | {:.0f} kB |\n", error, 100 * on.change, on.ns,
                          on.median_bytes / 1024);
    }
  }
  return text + "\n";
}

}  // namespace hapticd::bench_mat
