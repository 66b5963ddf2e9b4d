// SPDX-License-Identifier: MIT
/// A scene brought to life: instances created and activated, the core and the simulation side joined by a link. Used by
/// run, trace, explain and tests alike.
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
  double rate = 1000;  ///< [Hz]
  uint32_t probe_count = 1;
  uint32_t spare_models = 0;   ///< places for models that are added during the run
  bool measure = false;        ///< measures the CPU time of every step
  bool budgets = false;        ///< tells every step how much CPU time of the tick is left
  double evaluation_ns = 0;    ///< > 0: costs are counted, at so much per evaluation, instead of measured
  double max_force = 0;        ///< [N] most that any arm lets through to the hand; 0: unknown
  bool former_claims = false;  ///< as in recordings without claims, see CoreSettings
};

class World {
 public:
  /// [main] Creates and activates every model. The error names the model and gives the plugin's own words.
  static Result<std::unique_ptr<World>> build(const scene::Scene& scene, const WorldOptions& options,
                                              const host::Services::Log& log);

  /// [main] Creates and activates one more model while the others run; it is felt once the servo adopts it.
  Result<std::unique_ptr<host::ShapeInstance>> prepare(const scene::Model& model, const host::Services::Log& log) const;

  /// [main] Keeps the shape of an empty place alive, and has it searched from now on.
  void keep(uint32_t place, std::unique_ptr<host::ShapeInstance> shape, const scene::Model& model);

  /// [main] The model of a place is no longer searched; called before the servo is told to release it.
  void forget(uint32_t place) { proximity_->remove(place); }

  /// [main] Destroys the shape of a place that the servo has released.
  void destroy(uint32_t place) { shapes_[place].reset(); }

  Core& core() { return *core_; }
  sim::Proximity& proximity() { return *proximity_; }
  link::Link& link() { return *link_; }
  /// [main] What runs the simulation side in step with simulated time.
  Lockstep lockstep() {
    return {*core_, [this] { proximity_->search(); }};
  }
  const std::vector<std::unique_ptr<host::ShapeInstance>>& shapes() const { return shapes_; }

  /// How many models there may be at a time.
  uint32_t places() const { return static_cast<uint32_t>(core_->models().size()); }

  /// Some shape reads velocities, so an estimator must run.
  bool needsVelocity() const { return (needs_ & HSP_R_VELOCITY) != 0; }
  /// [N/m] The stiffest contact that the models claim.
  double maxStiffness() const { return max_stiffness_; }

  /// Bytes that the models hold in locked memory, as they report it.
  uint64_t lockedBytes() const { return locked_bytes_; }

 private:
  World() = default;
  hsp_activation activation_{};
  std::vector<std::unique_ptr<host::ShapeInstance>> shapes_;
  std::unique_ptr<link::Link> link_;
  std::unique_ptr<sim::Proximity> proximity_;
  std::unique_ptr<Core> core_;
  uint32_t needs_ = 0;
  double max_stiffness_ = 0;
  uint64_t locked_bytes_ = 0;
};

}  // namespace hapticd::servo
