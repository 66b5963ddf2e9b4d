// SPDX-License-Identifier: MIT
/// Finds memory that an instance does not free at its end.
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/clock.hpp"
#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

constexpr size_t kParts = 4;

/// [bytes] The least and the greatest use of memory in one part of the lives.
struct Extent {
  double least = 0, most = 0;
};

std::array<Extent, kParts> partsOf(const std::vector<double>& used) {
  std::array<Extent, kParts> parts;
  const auto length = static_cast<long>(used.size() / kParts);
  auto from = used.end() - static_cast<long>(kParts) * length;
  for (Extent& part : parts) {
    const auto [least, most] = std::minmax_element(from, from + length);
    part = {*least, *most};
    from += length;
  }
  return parts;
}

}  // namespace

double leakOf(const std::vector<double>& used) {
  if (used.size() < 2 * kParts) return 0;
  const auto parts = partsOf(used);
  double leak = HUGE_VAL;
  for (size_t i = 1; i < kParts; ++i)
    leak = std::min({leak, parts[i].least - parts[i - 1].least, parts[i].most - parts[i - 1].most});
  return std::max(leak, 0.0) / static_cast<double>(used.size() / kParts);
}

/// Makes and destroys the shape many times and measures the memory in use. The number of lives is the same on every
/// machine; only a shape whose lives take very long gets fewer.
Verdict createDestroyLeak(const Recipe& recipe, uint64_t) {
  constexpr int kFirst = 5, kLives = 40;
  constexpr Nanoseconds kLong = 3 * kNanosecondsPerSecond;
  constexpr double kNoLeak = 256;  // [bytes] per life
  const Nanoseconds begun = monotonicNow();
  std::vector<double> used;  // [bytes] after each life
  used.reserve(kLives);      // otherwise the growth of this list would count
  for (int i = 0; i < kFirst + kLives && monotonicNow() - begun < kLong; ++i) {
    {
      const Made made(recipe);
      if (!made.error.empty()) return made.error;
      for (int k = 0; k < 20; ++k) made.subject->step({onPath(*made.subject, k / 40.0)}, kConformanceDt);
    }
    if (i >= kFirst) used.push_back(static_cast<double>(mallinfo2().uordblks));
  }
  if (used.size() < 2 * kParts) return skipped("activation takes too long to repeat it");
  const double leak = leakOf(used);
  if (leak < kNoLeak) return "";
  return "it keeps about " + text(std::round(leak)) + " bytes in each life, from create() to destroy() (" +
         text(used.back() - used.front()) + " in " + std::to_string(used.size() - 1) +
         " lives); free in deactivate() what activate() took, and the rest in destroy()";
}

}  // namespace hapticd::conformance
