// SPDX-License-Identifier: MIT
/// Fuzzes model files of surfaces (YAML or JSON): reads, sews, searches, traces and draws them.
#include <cmath>

#include "kernels/trace/tracer.hpp"
#include "traced_shape/model_file.hpp"
#include "traced_shape/traced_shape.hpp"

namespace {

using Eigen::Vector3d;
using namespace hapticd;

void follow(const trace::Model& model, const Vector3d& start, const Vector3d& step) {
  constexpr double kRadius = 0.1;
  constexpr int kTicks = 4;
  trace::Tracer tracer(model);
  trace::Found found;
  model.search(start, kRadius, found);
  for (const auto* feet : {&found.nearest, &found.rivals})
    for (const trace::Near& near : *feet) tracer.activate(near.surface, near.u, near.v, near.distance);
  for (int i = 0; i < kTicks; ++i) {
    const trace::Foot foot = tracer.step(start + i * step);
    if (foot.surface < 0) continue;
    if (foot.surface >= model.surfaceCount() || !std::isfinite(foot.depth) || !foot.point.allFinite()) __builtin_trap();
    if (!(std::abs(foot.normal.norm() - 1) < 1e-6)) __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const ModelFile file = parseModelFile({reinterpret_cast<const char*>(data), size}, "fuzz.yaml");
    trace::ModelOptions options;
    options.edges = file.edges;
    options.form = size % 2 == 0 ? spline::Form::kTable : spline::Form::kNet;
    const trace::Model model(file.surfaces, options);
    const Vector3d middle = model.bounds().center(), corner = model.bounds().max();
    follow(model, middle, {1e-3, 0, 0});
    follow(model, corner, (middle - corner) / 4);
    follow(model, {0.01, -0.02, 0.03}, {1e9, 0, 0});
    tessellate(model, 0.01 * model.bounds().diagonal().norm() + 1e-6);
  } catch (const ModelFileError&) {
  } catch (const std::invalid_argument&) {  // the plugin's error for a model that cannot be traced
  }
  return 0;
}
