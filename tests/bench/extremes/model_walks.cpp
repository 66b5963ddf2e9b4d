// SPDX-License-Identifier: MIT
/// Walks of a hand over whole models. They cross edges, seams, poles and medial axes.
#include <algorithm>
#include <random>

#include "extreme_case.hpp"
#include "kernels/trace/tracer.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::extremes {
namespace {

using Eigen::Vector3d;

constexpr int kTicks = 5000;

Vector3d startOn(const trace::Model& model) {
  const trace::Patch& patch = model.patch(model.patchCount() / 2);
  const Eigen::Array2d middle = 0.5 * (patch.lo + patch.hi);
  spline::SurfacePoint E;
  patch.surface.evaluate1(middle[0], middle[1], E);
  return E.S;
}

/// Returns the nearest foot, found without memory from the results of a search and with as many evaluations as needed.
trace::Foot footAnew(trace::Tracer& tracer, const trace::Found& found, const Vector3d& p) {
  trace::TraceOptions thorough;
  thorough.unite = false;
  thorough.max_evaluations = 100'000;
  tracer.reset();
  for (const trace::Near& near : found.nearest) tracer.activate(near.surface, near.u, near.v, near.distance);
  return tracer.step(p, thorough);
}

Case walkOver(const std::string& model_name, double speed, double deepest) {
  constexpr double kOutside = 0.002;
  constexpr int kChange = 200;
  Case c;
  c.surfaces = readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + model_name + ".yaml").surfaces;
  c.bifurcation = true;
  c.walk = true;
  const trace::Model model(c.surfaces);
  trace::Tracer anew(model);
  trace::Found found;
  std::mt19937 random(5);
  std::normal_distribution<double> turn(0, 0.15);
  std::uniform_real_distribution<double> depth(-kOutside, deepest);
  Vector3d p = startOn(model), heading(1, 0, 0);
  double goal = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    model.search(p, 1, found);
    c.probe.push_back(p);
    c.distance.push_back(found.nearest.front().distance);
    const trace::Foot foot = footAnew(anew, found, p);
    if (tick % kChange == 0) goal = depth(random);
    heading += Vector3d(turn(random), turn(random), turn(random)) +
               0.5 * std::clamp((foot.depth - goal) / 0.002, -1.0, 1.0) * foot.normal;
    heading.normalize();
    p += speed / c.rate * heading;
  }
  return c;
}

}  // namespace

std::vector<Case> modelWalks() {
  std::vector<Case> cases;
  for (const char* name : {"box", "cylinder", "torus", "sphere", "goblet", "teapot"})
    for (double speed : {1.0, 2.0}) {
      cases.push_back(walkOver(name, speed, 0.005));
      char text[80];
      std::snprintf(text, sizeof text, "%s, a hand at %g m/s to 5 mm inside", name, speed);
      cases.back().name = text;
    }
  Case direct = walkOver("teapot", 0.5, 0.003);
  for (int steps : {1, 4}) {
    direct.name = "teapot, 0.5 m/s to 3 mm inside, method dpt x" + std::to_string(steps);
    direct.direct_steps = steps;
    cases.push_back(direct);
  }
  return cases;
}

}  // namespace hapticd::extremes
