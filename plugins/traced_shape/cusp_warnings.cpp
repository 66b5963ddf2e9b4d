// SPDX-License-Identifier: MIT
#include "cusp_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

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

/// True if the weights of the rows of a fold, and of the rows beside it, are multiples of one another.
bool weightsAreAlike(const SurfaceData& surface, int axis, int first) {
  if (surface.weights.empty()) return true;
  const int from = std::max(first - 1, 0);
  const int to = std::min(first + surface.degree[static_cast<std::size_t>(axis)], surface.count(axis) - 1);
  const auto weight = [&](int row, int line) { return surface.weights[pointAt(surface, axis, row, line)]; };
  for (int row = from + 1; row <= to; ++row)
    for (int line = 1; line < surface.count(1 - axis); ++line) {
      const double expected = weight(row, 0) / weight(from, 0) * weight(from, line);
      if (!(std::abs(weight(row, line) - expected) <= 1e-12 * expected)) return false;
    }
  return true;
}

}  // namespace

void warnOfCusps(const SurfaceData& surface, std::size_t index, Problems& odd) {
  constexpr double kSame = 1e-9;  // as in kernels/spline/cusp.cpp
  for (const int axis : {0, 1}) {
    const int degree = surface.degree[static_cast<std::size_t>(axis)];
    if (degree < 2) continue;
    for (int first = 0; first + degree <= surface.count(axis); ++first) {
      const Fold fold = foldAt(surface, axis, first);
      const bool alike = weightsAreAlike(surface, axis, first);
      if (!(fold.length > 0) || (alike && fold.apart <= kSame * fold.length)) continue;
      std::array<char, 320> text{};
      std::snprintf(
          text.data(), text.size(),
          "rows %d to %d of control points along %s coincide to %.2g m%s, so the surface folds there and feet "
          "near the fold may be wrong; make it two surfaces that meet in an edge",
          first, first + degree - 1, axis == 0 ? "u" : "v", fold.apart,
          alike ? "" : ", but their weights are no multiples of one another");
      return odd.add({{"surfaces", 0}, {"", index}, {"points", 0}}, text.data());
    }
  }
}

}  // namespace hapticd
