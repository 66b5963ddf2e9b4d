// SPDX-License-Identifier: MIT
/// Which model each number of a recording means. A model that leaves gives its number to one that comes later, so a
/// number has a model from a tick on.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "record/recording.hpp"

namespace hapticd::servo {

/// A model of a run.
struct RunModel {
  uint32_t number = 0;  ///< in the columns `model`
  uint64_t since = 0;   ///< first tick in which the number means this model
  scene::Model model;   ///< called "model 7" if the recording does not say more; a model that came later has no path
};

class RunModels {
 public:
  static constexpr size_t kNone = SIZE_MAX;

  /// [main] Takes the models of the scene, and those that were added later: the daemon describes each in the stream
  /// `marks`. Older recordings, and black boxes that have lost these rows, have only the order that added it.
  RunModels(const record::Recording& recording, const scene::Scene& scene);

  /// [main] The models of the scene by their numbers, then those that came later, in the order in which they came.
  const std::vector<RunModel>& all() const { return models_; }

  /// [main] Returns the place in all() of the model that has this number in this tick; kNone if no model is known.
  size_t find(double number, double tick) const;

  /// [main] Returns the name of this model, or "model 7".
  std::string nameOf(double number, double tick) const;

 private:
  void readDescriptions(const record::RecordedStream* marks);
  void addNameless(const record::RecordedStream* orders, size_t of_scene);

  std::vector<RunModel> models_;
  std::vector<std::vector<size_t>> of_number_;  ///< places in models_, in the order of ticks
};

}  // namespace hapticd::servo
