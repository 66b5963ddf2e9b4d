// SPDX-License-Identifier: MIT
/// The models of a scene, ready to run: shapes are created and activated, and the core and the proximity search are
/// connected. The commands run, trace and explain use it, and tests.
#pragma once
#include <memory>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "host/shape_instance.hpp"
#include "link/link.hpp"
#include "servo/core/core.hpp"
#include "servo/loop/lockstep.hpp"
#include "sim/proximity.hpp"

namespace hapticd::servo {

struct WorldOptions {
  double rate = 1000;  ///< [Hz] rate of the servo
  uint32_t probe_count = 1;
  uint32_t spare_models = 0;  ///< places for models that are added during the run
  bool measure = false;       ///< true: measure the CPU time of every step
  bool budgets = false;       ///< true: give every step the CPU time that is left in the tick
  /// [ns] for tests: if > 0, a step costs this time for each evaluation of the surface, and not its measured time
  double evaluation_ns = 0;
  double max_force = 0;        ///< [N] largest force that any arm lets through to the hand; 0: unknown
  bool former_claims = false;  ///< for old recordings, see CoreSettings
  bool gaps_jump = false;      ///< see CoreSettings
  /// true: models that the scene disables are not traced until they are enabled, as in a run; false: they are as if
  /// enabled, for tools that judge all models
  bool keep_disabled = false;
};

class World {
 public:
  /// [main] Creates and activates every model. An error names the model and contains the plugin's own message.
  static Result<std::unique_ptr<World>> build(const scene::Scene& scene, const WorldOptions& options,
                                              const host::Services::Log& log);

  /// [main] Creates and activates one more model during a run. It is felt only after the servo has adopted it.
  Result<std::unique_ptr<host::ShapeInstance>> prepare(const scene::Model& model, const host::Services::Log& log) const;

  /// [main] Puts a shape into an empty place, which owns it from now on, and adds it to the proximity search, unless it
  /// starts disabled.
  void store(uint32_t place, std::unique_ptr<host::ShapeInstance> shape, const scene::Model& model);

  /// [main] Removes the model of a place from the proximity search. Call it before the order kRelease is given to the
  /// servo.
  void forget(uint32_t place) { proximity_->remove(place); }

  /// [main] Adds a model that started disabled to the proximity search. Call it before the order kEnable is given to
  /// the servo. Returns false if the search has it already.
  bool wake(uint32_t place, const scene::Model& model);

  /// [main] Destroys the shape of a place that the servo has released.
  void destroy(uint32_t place) { shapes_[place].reset(); }

  Core& core() { return *core_; }
  sim::Proximity& proximity() { return *proximity_; }
  link::Link& link() { return *link_; }
  /// [main] Returns the object that runs the proximity search in step with virtual time.
  Lockstep lockstep() {
    return {*core_, [this] { proximity_->search(); }};
  }
  const std::vector<std::unique_ptr<host::ShapeInstance>>& shapes() const { return shapes_; }

  /// Returns how many models the run can have at a time.
  uint32_t places() const { return static_cast<uint32_t>(core_->models().size()); }

  /// True if some shape reads velocities, so that they must be estimated.
  bool needsVelocity() const { return (needs_ & HSP_R_VELOCITY) != 0; }

  /// Returns how many bytes must be locked in memory for the models, as the models report it.
  uint64_t lockedBytes() const { return locked_bytes_; }

 private:
  World() = default;
  hsp_activation activation_{};
  std::vector<std::unique_ptr<host::ShapeInstance>> shapes_;
  std::unique_ptr<link::Link> link_;
  std::unique_ptr<sim::Proximity> proximity_;
  std::unique_ptr<Core> core_;
  uint32_t needs_ = 0;
  uint64_t locked_bytes_ = 0;
};

}  // namespace hapticd::servo
