// SPDX-License-Identifier: MIT
/// How much of a motion touches the models: errors of forces show only where a model is touched.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "tune/measurement.hpp"

namespace hapticd::tune {

struct Touches {
  std::string model;
  size_t ticks = 0;      ///< number of ticks in which the tip was inside the model
  double nearest_m = 0;  ///< [m] least distance of the tip from the model; negative if the tip was inside
};

/// [main] Counts the touches of each model of a scene. A model that was never traced has an infinite distance.
std::vector<Touches> touchesOf(const scene::Scene& scene, const Run& run);

/// [main] Returns a sentence that says which models were not touched, or "".
std::string untouched(const std::vector<Touches>& touches);

}  // namespace hapticd::tune
