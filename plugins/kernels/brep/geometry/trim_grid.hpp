// SPDX-License-Identifier: MIT
/// The reference points of the cells of a trim's grid: for each cell it is stored whether this point is inside the
/// loops. The builder and Trim::inside() must compute the points with the same result, bit for bit.
#pragma once
#include <cstdint>

namespace hapticd::brep {

template <class Index>
inline constexpr Index kInsideBit = Index{1} << (8 * sizeof(Index) - 1);

/// [any] Returns u at the right border of column i.
inline double gridBorder(double lo, double cell, int i) noexcept {
  return lo + cell * (i + 1);
}
/// [any] Returns v of the reference points of row j. It is not on a border of the grid, because loops often run along
/// such lines.
inline double gridHeight(double lo, double cell, int j) noexcept {
  constexpr double kHeight = 0.437;
  return lo + cell * (j + kHeight);
}

}  // namespace hapticd::brep
