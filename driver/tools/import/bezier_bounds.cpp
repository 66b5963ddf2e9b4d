// SPDX-License-Identifier: MIT
/// The size of Bezier patches as a person would measure it: that of their surfaces, not of their control points.
#include <utility>

#include "import/bezier_import.hpp"

namespace hapticd::importing {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kExact = 1e-6;  ///< share of the size of the control net
constexpr int kMostHalvings = 40;

/// Halves a patch along an axis by de Casteljau's algorithm.
std::pair<BezierPatch, BezierPatch> halves(const BezierPatch& patch, int axis) {
  std::pair<BezierPatch, BezierPatch> half{patch, patch};
  const int rows = patch.degree_u + 1, columns = patch.degree_v + 1, count = axis == 0 ? rows : columns;
  const int lines = axis == 0 ? columns : rows, step = axis == 0 ? columns : 1, stride = axis == 0 ? 1 : columns;
  for (int line = 0; line < lines; ++line) {
    const auto at = [&](int i) { return static_cast<std::size_t>(line * stride + i * step); };
    std::vector<Vector3d>& low = half.first.points;
    std::vector<Vector3d>& high = half.second.points;
    for (int level = 0; level < count; ++level) {
      low[at(level)] = high[at(0)];
      for (int i = 0; i + level + 1 < count; ++i) high[at(i)] = 0.5 * (high[at(i)] + high[at(i + 1)]);
    }
  }
  return half;
}

/// Extends a box by a patch. Its corners lie on the surface, and its control points enclose it.
void extend(AlignedBox3d& box, const BezierPatch& patch, double slack, int halvings) {
  const std::vector<Vector3d>& points = patch.points;
  const auto columns = static_cast<std::size_t>(patch.degree_v) + 1;
  for (const std::size_t corner : {std::size_t{0}, columns - 1, points.size() - columns, points.size() - 1})
    box.extend(points[corner]);
  const AlignedBox3d enough(box.min().array() - slack, box.max().array() + slack);
  bool inside = true;
  for (const Vector3d& point : points) inside = inside && enough.contains(point);
  if (inside || halvings == kMostHalvings) return;
  const auto [low, high] = halves(patch, halvings % 2);
  extend(box, low, slack, halvings + 1);
  extend(box, high, slack, halvings + 1);
}

}  // namespace

AlignedBox3d boundsOf(const BezierModel& model) {
  AlignedBox3d net, box;
  for (const BezierPatch& patch : model.patches)
    for (const Vector3d& point : patch.points) net.extend(point);
  const double slack = net.isEmpty() ? 0 : kExact * net.diagonal().norm();
  for (const BezierPatch& patch : model.patches) extend(box, patch, slack, 0);
  return box;
}

}  // namespace hapticd::importing
