// SPDX-License-Identifier: MIT
#include "kernels/trace/free_sides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::trace {
namespace {

/// Returns how many rows of control points the end of a surface depends on: one if the knots are clamped there.
int rowsAtEnd(const spline::SurfaceData& data, int axis, bool first) {
  const std::vector<double>& knots = data.knots[static_cast<std::size_t>(axis)];
  const double end = data.domain(axis)[first ? 0 : 1];
  const auto equal = std::count(knots.begin(), knots.end(), end);
  const int degree = data.degree[static_cast<std::size_t>(axis)];
  return std::max(1, degree + 1 - static_cast<int>(equal));
}

}  // namespace

SideBoxes boxesOfSides(const spline::SurfaceData& data) {
  const std::array<int, 2> count{data.count(0), data.count(1)};
  SideBoxes boxes;
  for (int side = 0; side < kSides; ++side) {
    const int axis = Patch::axisOf(side);
    const bool first = side % 2 == 0;
    const int rows = rowsAtEnd(data, axis, first), all = count[static_cast<std::size_t>(axis)];
    std::array<int, 2> lo{0, 0}, hi = count;
    lo[static_cast<std::size_t>(axis)] = first ? 0 : all - rows;
    hi[static_cast<std::size_t>(axis)] = first ? rows : all;
    for (int i = lo[0]; i < hi[0]; ++i)
      for (int j = lo[1]; j < hi[1]; ++j)
        boxes[static_cast<std::size_t>(side)].extend(data.points[static_cast<std::size_t>(i * count[1] + j)]);
  }
  return boxes;
}

void FreeSides::keep(const std::vector<Patch>& patches, const std::vector<SideBoxes>& boxes) {
  for (std::size_t i = 0; i < patches.size(); ++i)
    for (std::size_t side = 0; side < kSides; ++side)
      if (patches[i].sides[side].kind == SideKind::kFree) boxes_.push_back(boxes[i][side]);
  boxes_.shrink_to_fit();
}

double FreeSides::atLeast(const Eigen::Vector3d& p) const noexcept {
  if (boxes_.size() > kMost) return 0;
  double least2 = std::numeric_limits<double>::infinity();
  for (const Eigen::AlignedBox3d& box : boxes_) least2 = std::min(least2, box.squaredExteriorDistance(p));
  return std::sqrt(least2);
}

}  // namespace hapticd::trace
