// SPDX-License-Identifier: MIT
#include "tune/touches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::tune {

std::vector<Touches> touchesOf(const scene::Scene& scene, const Run& run) {
  std::vector<Touches> all;
  for (size_t m = 0; m < run.models; ++m) {
    Touches touches{m < scene.models.size() ? scene.models[m].name : "", 0, std::numeric_limits<double>::infinity()};
    for (size_t i = m; i < run.answers.size(); i += run.models) {
      if (!run.answers[i].traced) continue;
      touches.ticks += run.answers[i].depth > 0 ? 1 : 0;
      touches.nearest_m = std::min(touches.nearest_m, -run.answers[i].depth);
    }
    all.push_back(touches);
  }
  return all;
}

std::string untouched(const std::vector<Touches>& touches) {
  std::string names;
  size_t count = 0;
  for (const Touches& of : touches) {
    if (of.ticks > 0) continue;
    ++count;
    names += (names.empty() ? "" : ", ") + of.model;
    names += std::isfinite(of.nearest_m) ? fmt::format(" (nearest: {:.3g} mm)", of.nearest_m * 1e3) : " (never near)";
  }
  if (count == 0) return "";
  return fmt::format(
      "the motion does not touch {}, so {} errors are those of a tip in the air, and no force is compared\n"
      "  fix: give a motion that touches, with --probe FILE or --motion RECORDING, or move the hand of the scene",
      names,
      count == touches.size() ? "all"
      : count == 1            ? "its"
                              : "their");
}

}  // namespace hapticd::tune
