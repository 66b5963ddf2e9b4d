// SPDX-License-Identifier: MIT
/// Coefficients of a splitting method of fourth order. Two motions alternate, each exact for one part of the energy.
/// Together they give a motion whose energy error stays bounded for ever.
#pragma once
#include <array>
#include <cstddef>

namespace hapticd::dynamics {

/// Method S6 of Blanes and Moan (2002), J. Comput. Appl. Math. 142. Parts A and B of a step alternate; A comes first
/// and last.
struct Splitting {
  static constexpr std::size_t kStages = 6;
  static constexpr double kA1 = 0.0792036964311957, kA2 = 0.353172906049774, kA3 = -0.0420650803577195;
  static constexpr double kB1 = 0.209515106613362, kB2 = -0.143851773179818;
  static constexpr double kA4 = 1 - 2 * (kA1 + kA2 + kA3), kB3 = 0.5 - (kB1 + kB2);
  static constexpr std::array<double, kStages + 1> kA = {kA1, kA2, kA3, kA4, kA3, kA2, kA1};
  static constexpr std::array<double, kStages> kB = {kB1, kB2, kB3, kB3, kB2, kB1};

  /// [rt] Makes one step of h: calls part_a and part_b in turn, each with its share of h.
  template <class A, class B>
  static void step(double h, const A& part_a, const B& part_b) noexcept {
    for (std::size_t i = 0; i < kStages; ++i) {
      part_a(kA[i] * h);
      part_b(kB[i] * h);
    }
    part_a(kA[kStages] * h);
  }
};

}  // namespace hapticd::dynamics
