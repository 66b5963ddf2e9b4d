// SPDX-License-Identifier: MIT
/// Tests and choices on several numbers at once. They have no branches: where a probe moves by a triangle a tick, a
/// processor predicts every second branch on a distance wrongly, and each costs as much as a box.
#pragma once
#include <cstdint>
#include <limits>

#include "kernels/brep/tree/coarse.hpp"

namespace hapticd::brep {

/// The result of a test of four floats: all bits of a lane are set where it is true.
using Test4 = std::int32_t __attribute__((vector_size(16)));

inline constexpr Float4 kEndless4 = Float4{} + std::numeric_limits<float>::infinity();

/// [any] Returns bit i for each lane i of a test that is true.
inline std::uint32_t bitsOf(const Test4& test) noexcept {
  const Test4 bits = test & Test4{1, 2, 4, 8};
  const Test4 pairs = bits | __builtin_shufflevector(bits, bits, 2, 3, 0, 1);
  return static_cast<std::uint32_t>(pairs[0] | pairs[1]);
}

/// [any] Returns in how many lanes a test is true.
inline int countOf(const Test4& test) noexcept {
  const Test4 pairs = test + __builtin_shufflevector(test, test, 2, 3, 0, 1);
  return -(pairs[0] + pairs[1]);
}

/// [any] Replaces one lane. It writes all four: a processor that reads four numbers, of which one was written alone
/// just before, has to wait.
inline void putLane(Float4& x, int lane, float number) noexcept {
  x = Test4{0, 1, 2, 3} == Test4{} + lane ? Float4{} + number : x;
}

/// [any] Writes the four numbers of each of four vectors side by side: to[i] has number i of each.
inline void transpose(const Float4& a, const Float4& b, const Float4& c, const Float4& d, Float4* to) noexcept {
  const Float4 ab0 = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab2 = __builtin_shufflevector(a, b, 2, 6, 3, 7),
               cd0 = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd2 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  to[0] = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
  to[1] = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
  to[2] = __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5);
  to[3] = __builtin_shufflevector(ab2, cd2, 2, 3, 6, 7);
}

/// [any] Returns the lesser number of each lane.
inline Float4 lesser(const Float4& a, const Float4& b) noexcept {
  return a < b ? a : b;
}

/// [any] Returns the least of four numbers.
inline float leastOf(const Float4& x) noexcept {
  const Float4 pairs = lesser(x, __builtin_shufflevector(x, x, 2, 3, 0, 1));
  return pairs[0] < pairs[1] ? pairs[0] : pairs[1];
}

}  // namespace hapticd::brep
