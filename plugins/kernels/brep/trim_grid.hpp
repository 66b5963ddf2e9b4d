// SPDX-License-Identifier: MIT
/// Where the reference points of the cells of a trim's grid are. Builder and test must compute them alike, bit for bit.
#pragma once
#include <cstdint>

namespace hapticd::brep {

inline constexpr std::uint32_t kInsideBit = 0x80000000u;

/// [any] The right border of column i.
inline double gridBorder(double lo, double cell, int i) noexcept {
  return lo + cell * (i + 1);
}
/// [any] The height of the reference points of row j: no border, where loops like to run.
inline double gridHeight(double lo, double cell, int j) noexcept {
  constexpr double kHeight = 0.437;
  return lo + cell * (j + kHeight);
}

}  // namespace hapticd::brep
