// SPDX-License-Identifier: MIT
/// Which model each number of a recording means. A model that leaves gives its number to one that comes later, so a
/// number has a model from a tick on.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "record/recording.hpp"
#include "session/replay/fingerprint.hpp"

namespace hapticd::servo {

/// A model of a run.
struct RunModel {
  uint32_t number = 0;                  ///< in the columns `model`
  uint64_t since = 0;                   ///< first tick in which the number means this model
  uint64_t until = UINT64_MAX;          ///< tick in which it left; UINT64_MAX if it stayed
  scene::Model model;                   ///< called "model 7" if the recording does not say more
  std::vector<Fingerprint> files = {};  ///< of a model that came later; those of the scene are in RecordedRun
  std::string lack = {};                ///< why a replay cannot build a model that came later; "" if it can
};

class RunModels {
 public:
  static constexpr size_t kNone = SIZE_MAX;

  /// [main] Takes the models of the scene, and those that were added later: the daemon describes each in the stream
  /// `marks`. Older recordings, and black boxes that have lost these rows, have only the order that added it.
  RunModels(const record::Recording& recording, const scene::Scene& scene);

  /// [main] The models of the scene by their numbers, then those that came later, in the order in which they came.
  const std::vector<RunModel>& all() const { return models_; }
  /// [main] The models that came later, in the order in which they came.
  std::vector<RunModel> later() const { return {models_.begin() + of_scene_, models_.end()}; }

  /// [main] Returns the place in all() of the model that has this number in this tick; kNone if no model is known.
  size_t find(double number, double tick) const;

  /// [main] Returns the name of this model, or "model 7".
  std::string nameOf(double number, double tick) const;

 private:
  void readDescriptions(const record::RecordedStream* marks);
  void addNameless(const record::RecordedStream* orders);
  void noteLeaving(const record::RecordedStream* orders);

  std::vector<RunModel> models_;
  std::ptrdiff_t of_scene_ = 0;                 ///< number of models of the scene
  std::vector<std::vector<size_t>> of_number_;  ///< places in models_, in the order of ticks
};

}  // namespace hapticd::servo
