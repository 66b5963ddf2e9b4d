// SPDX-License-Identifier: MIT
/// The models that came during a recorded run. They are built before the replay begins, and the replay adopts each in
/// the tick in which the run did.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "record/recording.hpp"
#include "servo/core/core.hpp"
#include "session/replay/run_models.hpp"
#include "world/world.hpp"

namespace hapticd::servo {

class LaterModels {
 public:
  /// [main] Returns how many places these models need after those of the scene.
  static uint32_t placesFor(const std::vector<RunModel>& described, size_t of_scene);

  /// [main] Builds the model of each order kAdopt in turn, up to the first one that cannot be built.
  /// @param described the models that came, by the ticks in which they came
  void build(const record::RecordedStream& orders, const std::vector<RunModel>& described, const World& world,
             const host::Services::Log& log);

  /// First tick that cannot be replayed, because a model that came in it cannot be built; UINT64_MAX if there is none.
  uint64_t end() const { return end_; }
  const std::string& why() const { return why_; }  ///< why that model cannot be built; "" if there is none

  /// [main] Puts the next model into its place in the world. Returns its state for the order kAdopt, or nullptr if the
  /// place is not empty; then the recording is damaged.
  ModelState* adopt(uint32_t place, World& world);

 private:
  struct Built {
    std::unique_ptr<host::ShapeInstance> shape;
    scene::Model model;
    ModelState state;
  };
  std::string add(const RunModel* described, const World& world, const host::Services::Log& log);

  std::deque<Built> built_;  ///< in the order in which they came; the servo holds pointers to the states
  size_t next_ = 0;
  uint64_t end_ = UINT64_MAX;
  std::string why_;
};

/// Returns the model that has this number in this tick and came during the run, or nullptr.
const RunModel* laterModel(const std::vector<RunModel>& described, uint32_t number, uint64_t tick);

}  // namespace hapticd::servo
