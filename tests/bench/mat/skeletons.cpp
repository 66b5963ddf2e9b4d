// SPDX-License-Identifier: MIT
/// Measures searches on ten skeletons: failures and errors compared with brute force, evaluations and times.
#include <fmt/format.h>

#include <random>

#include "bench.hpp"
#include "bodies.hpp"

namespace hapticd::bench_mat {
namespace {

using Eigen::Vector3d;
using medial::Skeleton;
using medial::SkeletonFoot;

constexpr int kQueries = 30'000;
constexpr double kRadius = .01;

struct Cold {
  int failures = 0;
  double worst = 0, ns = 0, evaluations = 0;
};

Cold cold(const medial::test::Sheet& sheet, const Skeleton& skeleton) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> unit(0, 1), sign(-1, 1);
  const medial::test::BruteForce brute(skeleton);
  Cold result;
  std::vector<Vector3d> queries;
  for (int k = 0; k < kQueries; ++k) {
    const double s = unit(engine), t = unit(engine), x = sign(engine), y = sign(engine), z = sign(engine);
    queries.push_back(sheet.at(s, t) + .012 * Vector3d(x, y, z));
    const SkeletonFoot foot = skeleton.search(queries.back(), {});
    // Each depth found is that of some sphere. So it is wrong only if another sphere gives a greater depth.
    const double error = std::max(0.0, brute.depth(queries.back()) - foot.depth);
    result.worst = std::max(result.worst, error);
    result.failures += error > .01 * kRadius ? 1 : 0;
    result.evaluations += double(foot.evaluations) / kQueries;
  }
  double sum = 0;
  result.ns = 1e9 * leastTime(11, 200, [&](int i) {
                sum += skeleton.search(queries[static_cast<std::size_t>(i) % queries.size()], {}).depth;
              });
  return result;
}

struct Warm {
  int most = 0;
  double mean = 0, ns = 0;
};

/// Measures a stroke at 0.1 m/s and 1 kHz, 6 mm away from the skeleton. Each search starts from the last foot.
Warm warm(const Skeleton& skeleton) {
  std::vector<Vector3d> path;
  for (int k = 0; k < 10'000; ++k) {
    const double s = .5 + .3 * std::sin(4e-3 * k), t = .5 + .3 * std::cos(3.1e-3 * k);
    spline::SurfacePoint at;
    skeleton.surface().evaluate1(s, t, at);
    const Vector3d normal = skeleton.curve() ? at.Sv.unitOrthogonal() : at.Su.cross(at.Sv).normalized();
    path.push_back(at.S + .006 * normal);
  }
  Warm result;
  SkeletonFoot foot = skeleton.search(path[0], {});
  for (std::size_t k = 1; k < path.size(); ++k) {
    foot = skeleton.nearest(path[k], foot.u, foot.v, {});
    result.most = std::max(result.most, foot.evaluations);
    result.mean += foot.evaluations / 1e4;
  }
  foot = skeleton.search(path[0], {});
  result.ns = 1e9 * leastTime(11, 900, [&](int i) {
                foot = skeleton.nearest(path[static_cast<std::size_t>(i) % path.size()], foot.u, foot.v, {});
              });
  return result;
}

}  // namespace

std::string skeletonTable() {
  std::string text = fmt::format(
      "## Searches\n\n{} random points within 12 mm of each skeleton of 7 x 7 points, searched with no start known, "
      "against brute force; then 10,000 ticks of a stroke at about 0.1 m/s, each from the last foot. A failure is a "
      "depth wrong by 1 % of the radius.\n\n"
      "| skeleton | radii | failures | worst depth error | cold | warm: mean evaluations | most | warm |\n"
      "|---|---|---|---|---|---|---|---|\n",
      kQueries);
  for (const medial::test::Sheet& sheet : medial::test::sheets()) {
    for (const bool varying : {false, true}) {
      const Skeleton skeleton = medial::test::build(sheet, varying);
      const Cold c = cold(sheet, skeleton);
      const Warm w = warm(skeleton);
      text += fmt::format("| {} | {} | {} | {:.1e} m | {:.1f} us | {:.2f} | {} | {:.0f} ns |\n", sheet.name,
                          varying ? "vary" : "equal", c.failures, c.worst, 1e-3 * c.ns, w.mean, w.most, w.ns);
    }
  }
  return text + "\n";
}

}  // namespace hapticd::bench_mat
