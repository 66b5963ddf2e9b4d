// SPDX-License-Identifier: MIT
/// Moves the hands of simulated arms through a scene in virtual time, before the scene is run. The loop is the servo
/// loop of a run without log and recording.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "servo/safety/limiter.hpp"
#include "session/telemetry/stop_counts.hpp"
#include "session/telemetry/swing.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// The contacts of one model with all hands.
struct WalkedModel {
  uint64_t touched = 0;                            ///< ticks in which a tip was inside
  double depth = 0, force = 0;                     ///< greatest depth [m], greatest force [N]
  double seconds = 0;                              ///< [s] time of all its steps; 0 if the world does not measure
  double travel = 0;                               ///< [m] farthest distance of the model from where it began
  Eigen::Vector3d push = Eigen::Vector3d::Zero();  ///< unit vector in the model frame: direction in which the tip
                                                   ///< pressed at the greatest force
  bool clicked = false;                            ///< the model reported an event (HSP_OUT_EVENT)
};

/// The contacts of one hand with all models.
struct WalkedArm {
  uint64_t contact = 0, cut = 0;  ///< ticks with a force after the ramp; how many of them had a force that a limit cut
  std::array<uint64_t, servo::kLimitCount> limits{};  ///< ticks with a cut force, for each limit
  double asked = 0;      ///< [N] greatest sum of the forces of all models, before the limits
  double depth = 0;      ///< [m] greatest depth in any model
  uint32_t deepest = 0;  ///< index of the model with the greatest depth
  bool touched = false;
  bool began_inside = false;  ///< the tip was inside a model at the first tick
  double away = HUGE_VAL;     ///< [m] least distance from any model, or from a box around it
  uint32_t nearest = 0;       ///< index of the model at the least distance
  uint32_t end = 0;           ///< number of the first joint that was at an end of its range there, from 1; 0 for none
  servo::StopCounts stops;    ///< ticks in which each joint was at an end of its range
  servo::Swing swing;         ///< of the tip
  double rate = 0;            ///< [Hz] of the arm's samples; 0: unknown
};

struct Walk {
  bool whole = false;  ///< true if every hand has done its whole motion once
  /// true if it took so much processor time that it was ended before that; then nothing else is to be judged, because
  /// the result would depend on the speed of the machine
  bool late = false;
  uint64_t ticks = 0;  ///< ticks that were run
  double period = 0;   ///< [s] period of a tick
  std::vector<WalkedModel> models;
  std::vector<WalkedArm> arms;
  /// What `run` would report about the plugin of each model: why it was silenced, or what is odd in its forces.
  std::vector<std::vector<std::string>> judged;
  std::vector<bool> silenced;  ///< for each model: true if it was silenced
  uint64_t waits = 0;          ///< ticks in which the thread waited, for whatever reason
  uint32_t waiter = 0;         ///< index of the model whose steps took longest in most of these ticks
  /// true if there were so many of these ticks that the walk was ended; then nothing else is to be judged
  bool waited = false;
  std::string allocates;                 ///< model whose steps allocate memory, as `run` would report; "" if none does
  std::vector<servo::Limiter> limiters;  ///< limiter of each arm at the end of the walk
};

constexpr double kMostProcessor = 3;  ///< [s] of processor time, after which a walk is ended

/// [main] Runs at most 10 s and 10,000 ticks, and kMostProcessor. Returns nothing if an arm is not simulated or cannot
/// be started.
/// @param world world of the scene, built for as many probes as the scene has arms
std::optional<Walk> walkHands(const scene::Scene& scene, servo::World& world);

}  // namespace hapticd::diagnostics
