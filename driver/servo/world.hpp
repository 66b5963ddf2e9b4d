/// A scene brought to life: instances created and activated, the core and the simulation side joined by a link. Used by
/// run, trace, explain and tests alike.
#pragma once
#include <memory>
#include <vector>

#include "base/result.hpp"
#include "host/shape_instance.hpp"
#include "link/link.hpp"
#include "scene/scene.hpp"
#include "servo/core.hpp"
#include "sim/proximity.hpp"

namespace hapticd::servo {

struct WorldOptions {
  double rate = 1000;  ///< [Hz]
  uint32_t probe_count = 1;
  bool measure = false;  ///< take the CPU time of every step
  bool budgets = false;  ///< tell every step how much CPU time is left of the tick
};

class World {
 public:
  /// [main] Creates and activates every model. The error names the model and gives the plugin's own words.
  static Result<std::unique_ptr<World>> build(const scene::Scene& scene, const WorldOptions& options,
                                              const host::Services::Log& log);

  Core& core() { return *core_; }
  sim::Proximity& proximity() { return *proximity_; }
  link::Link& link() { return *link_; }
  const std::vector<std::unique_ptr<host::ShapeInstance>>& shapes() const { return shapes_; }

  /// Some shape reads velocities: an estimator must run.
  bool needsVelocity() const { return (needs_ & HSP_R_VELOCITY) != 0; }
  /// [N/m] The stiffest contact that the models claim.
  double maxStiffness() const { return max_stiffness_; }

  /// Bytes that the models hold in locked memory, as they report it.
  uint64_t lockedBytes() const { return locked_bytes_; }

 private:
  World() = default;
  std::vector<std::unique_ptr<host::ShapeInstance>> shapes_;
  std::unique_ptr<link::Link> link_;
  std::unique_ptr<sim::Proximity> proximity_;
  std::unique_ptr<Core> core_;
  uint32_t needs_ = 0;
  double max_stiffness_ = 0;
  uint64_t locked_bytes_ = 0;
};

}  // namespace hapticd::servo
