// SPDX-License-Identifier: MIT
/// Walks the hands of simulated arms through a scene in virtual time, before anybody runs it: the servo loop of a run,
/// without its books.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "description/scene.hpp"
#include "servo/safety/limiter.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// What hands met of one model.
struct WalkedModel {
  uint64_t touched = 0;                            ///< ticks in which a tip was inside
  double depth = 0, force = 0;                     ///< [m], [N] greatest
  double travel = 0;                               ///< [m] farthest from where it began
  Eigen::Vector3d push = Eigen::Vector3d::Zero();  ///< where the tip pressed at the greatest force; unit, model frame
  bool clicked = false;                            ///< it told of an event
};

/// What one hand met.
struct WalkedArm {
  uint64_t contact = 0, cut = 0;                      ///< ticks with a force, at full strength; those where it was cut
  std::array<uint64_t, servo::kLimitCount> limits{};  ///< those, by limit
  double asked = 0;                                   ///< [N] greatest force of all models together
  double depth = 0;                                   ///< [m] greatest
  uint32_t deepest = 0;                               ///< the model that this was in
  bool touched = false;
  double away = HUGE_VAL;  ///< [m] least from any model, or from a box about it
  uint32_t nearest = 0;    ///< that model
};

struct Walk {
  bool whole = false;  ///< every hand went everywhere it goes
  double period = 0;   ///< [s] of a tick
  std::vector<WalkedModel> models;
  std::vector<WalkedArm> arms;
  std::vector<servo::Limiter> limiters;  ///< of the arms, as they were at the end
};

/// [main] At most 10 s and 10,000 ticks of it. Nothing where an arm is not simulated, where one refuses, and where it
/// takes more than some seconds of processor time: what was seen until then would depend on the machine.
/// @param world of the scene, built for as many probes as it has arms
std::optional<Walk> walkHands(const scene::Scene& scene, servo::World& world);

}  // namespace hapticd::diagnostics
