// SPDX-License-Identifier: MIT
/// Where the hinges and sliders of a recording's models were in each tick. The rows hold poses; these are angles and
/// travels.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <optional>

#include "record/recording.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::cli {

/// The place of a joint in a tick.
struct JointPlace {
  double position = 0;  ///< [rad] of a hinge, [m] of a slider, from the pose in the scene
  int stop = 0;         ///< -1: it stands at its lowest end stop; 1: at its highest; 0: at none
};

/// Makes places of the poses of one model.
class JointMotion {
 public:
  /// Returns nothing if the model has no hinge and no slider.
  static std::optional<JointMotion> of(const scene::Model& model);

  /// Returns the place for the pose of the next row. Angles count whole turns, so the rows must come in their order.
  JointPlace next(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);

  bool turns() const { return turns_; }
  const char* unit() const { return turns_ ? "rad" : "m"; }
  double limit(int stop) const { return (*limits_)[stop > 0 ? 1 : 0]; }  ///< [rad or m], for a stop that next() gave

 private:
  JointMotion(const scene::Pose& start, const Eigen::Vector3d& axis, bool turns)
      : start_(start), axis_((start.orientation * axis).normalized()), turns_(turns) {}

  scene::Pose start_;
  Eigen::Vector3d axis_;  // in the world
  bool turns_;
  std::optional<std::array<double, 2>> limits_;
  double last_ = 0;
};

/// [main] Calls `take` for each tick of each model with a joint, in the order of the ticks.
/// @param take place of the model in models.all(), its joint, number of the tick, place of the joint
void eachJointPlace(const record::Recording& recording, const servo::RunModels& models,
                    const std::function<void(size_t, const JointMotion&, double, const JointPlace&)>& take);

}  // namespace hapticd::cli
