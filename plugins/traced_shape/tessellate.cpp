// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "traced_shape.hpp"

namespace hapticd {
namespace {

using Eigen::Array2d;
using trace::Patch;

/// Returns the number of cells along u and v: a chord over a step h is off by |C''| h^2 / 8 from a curve with the
/// second derivative C''.
std::array<int, 2> cellsOf(const Patch& patch, double chord_error) {
  constexpr int kProbes = 9, kMostSpans = 256;
  const Array2d range = patch.hi - patch.lo;
  double bend_u = 0, bend_v = 0;
  spline::SurfacePoint E;
  for (int i = 0; i < kProbes; ++i)
    for (int j = 0; j < kProbes; ++j) {
      const Array2d uv = patch.lo + range * Array2d(i, j) / (kProbes - 1.0);
      patch.surface.evaluate2(uv[0], uv[1], E);
      bend_u = std::max(bend_u, E.Suu.norm() * range[0] * range[0] + E.Suv.norm() * range[0] * range[1]);
      bend_v = std::max(bend_v, E.Svv.norm() * range[1] * range[1] + E.Suv.norm() * range[0] * range[1]);
    }
  const auto cells = [&](double bend, int axis) {
    const int spans = static_cast<int>(patch.surface.breaks(axis).size()) - 1;
    const double wanted = std::ceil(std::sqrt(bend / (8 * chord_error)));
    return std::clamp(std::isfinite(wanted) ? static_cast<int>(std::min<double>(wanted, kMostSpans)) : kMostSpans,
                      std::min(spans, kMostSpans), kMostSpans);
  };
  return {cells(bend_u, 0), cells(bend_v, 1)};
}

void addPatch(const Patch& patch, double chord_error, Mesh& mesh) {
  const auto [cells_u, cells_v] = cellsOf(patch, chord_error);
  const auto first = static_cast<uint32_t>(mesh.xyz.size() / 3);
  spline::SurfacePoint E;
  for (int i = 0; i <= cells_u; ++i)
    for (int j = 0; j <= cells_v; ++j) {
      const Array2d share(static_cast<double>(i) / cells_u, static_cast<double>(j) / cells_v);
      const Array2d uv = patch.lo + share * (patch.hi - patch.lo);
      patch.surface.evaluate1(uv[0], uv[1], E);
      const Eigen::Vector3f p = E.S.cast<float>(), n = patch.normalAt(uv).cast<float>();
      mesh.xyz.insert(mesh.xyz.end(), {p.x(), p.y(), p.z()});
      mesh.normals.insert(mesh.normals.end(), {n.x(), n.y(), n.z()});
    }
  const auto row = static_cast<uint32_t>(cells_v + 1);
  for (uint32_t i = 0; i < static_cast<uint32_t>(cells_u); ++i)
    for (uint32_t j = 0; j < static_cast<uint32_t>(cells_v); ++j) {
      const uint32_t a = first + i * row + j, b = a + row, c = b + 1, d = a + 1;
      if (patch.sign > 0) {
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
      } else {
        mesh.indices.insert(mesh.indices.end(), {a, c, b, a, d, c});
      }
    }
}

}  // namespace

Mesh tessellate(const trace::Model& model, double chord_error) {
  Mesh mesh;
  for (int i = 0; i < model.patchCount(); ++i) addPatch(model.patch(i), chord_error, mesh);
  return mesh;
}

}  // namespace hapticd
