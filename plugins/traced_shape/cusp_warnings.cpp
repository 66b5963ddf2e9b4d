// SPDX-License-Identifier: MIT
#include "cusp_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "kernels/spline/cusp.hpp"
#include "kernels/spline/refinement.hpp"

namespace hapticd {
namespace {

using spline::SurfaceData;

/// The rows of control points along an axis that coincide or nearly do.
struct Fold {
  int first = 0;
  double apart = 0;   ///< [m] greatest distance between their points on one line
  double length = 0;  ///< [m] of the longest line
};

std::size_t pointAt(const SurfaceData& surface, int axis, int row, int line) {
  const int columns = surface.count(1);
  return static_cast<std::size_t>(axis == 0 ? row * columns + line : line * columns + row);
}

double lengthOf(const SurfaceData& surface, int axis, int line) {
  double length = 0;
  for (int row = 1; row < surface.count(axis); ++row)
    length +=
        (surface.points[pointAt(surface, axis, row, line)] - surface.points[pointAt(surface, axis, row - 1, line)])
            .norm();
  return length;
}

/// Returns the fold that begins at a row; its length is 0 if there is none.
Fold foldAt(const SurfaceData& surface, int axis, int first) {
  constexpr double kNear = 1e-4;  // share of a line's length
  Fold fold{first, 0, 0};
  for (int line = 0; line < surface.count(1 - axis); ++line) {
    const double length = lengthOf(surface, axis, line);
    double apart = 0;
    for (int row = first + 1; row < first + surface.degree[static_cast<std::size_t>(axis)]; ++row)
      apart = std::max(apart, (surface.points[pointAt(surface, axis, row, line)] -
                               surface.points[pointAt(surface, axis, first, line)])
                                  .norm());
    if (!(apart <= kNear * length)) return {};
    fold.apart = std::max(fold.apart, apart);
    fold.length = std::max(fold.length, length);
  }
  return fold;
}

}  // namespace

void warnOfCusps(const SurfaceData& surface, std::size_t index, Problems& odd) {
  for (const int axis : {0, 1}) {
    const int degree = surface.degree[static_cast<std::size_t>(axis)];
    if (degree < 2) continue;
    for (int first = 0; first + degree <= surface.count(axis); ++first) {
      const Fold fold = foldAt(surface, axis, first);
      if (!(fold.length > 0)) continue;
      if (!spline::hasDoubtfulCusp(surface)) return;
      std::array<char, 320> text{};
      std::snprintf(
          text.data(), text.size(),
          "rows %d to %d of control points along %s coincide to %.2g m%s, so the surface folds there and feet "
          "near the fold may be wrong; make it two surfaces that meet in an edge",
          first, first + degree - 1, axis == 0 ? "u" : "v", fold.apart,
          spline::weightsAreAlike(surface, axis) ? "" : ", but their weights are no multiples of one another");
      return odd.add({{"surfaces", 0}, {"", index}, {"points", 0}}, text.data());
    }
  }
}

}  // namespace hapticd
