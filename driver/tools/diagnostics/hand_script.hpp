// SPDX-License-Identifier: MIT
/// What the hand of a simulated arm wants, as its files say it: how far round, how often and how fast it goes.
#pragma once
#include <Eigen/Core>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

struct HandScript {
  enum class Kind { kHold, kStroke, kPress, kTap, kCircle, kPath, kNone, kGuided };  ///< as the module lists them
  Kind kind = Kind::kHold;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();          ///< [m] device frame
  double radius = 0, sweep = 0, rise = 0, rate = 0;          ///< [m], [rad], [m], [Hz]
  double lead_in = 0;                                        ///< [s]
  double path_end = 0, path_speed = 0, path_fastest_at = 0;  ///< [s], [m/s], [s] of the file that it follows
  double path_way = 0;                                       ///< [m] of it in all

  /// It goes a way of its own: nobody else leads it, and it is there.
  bool goes() const { return kind != Kind::kNone && kind != Kind::kGuided; }
  bool presses() const { return kind == Kind::kPress || kind == Kind::kTap; }
  double speed() const;  ///< [m/s] the greatest of what it wants
  double once() const;   ///< [s] until it went everywhere it goes
};

/// [main] A parameter that the files give; nullptr: none.
const scene::Value* givenIn(const std::vector<scene::Value>& values, const char* id);

/// Where the files say what a hand does.
struct HandKey {
  document::Place place;
  std::string id = "hand";
};
/// [main] The first of some keys that the scene itself gives, else the first that the device file gives; the arm's own
/// place where neither does. A device file that the scene does not name has no place of its own: it ships, and what a
/// person can change is the scene.
HandKey keyOfHand(const scene::Scene& scene, const scene::Device& device, std::initializer_list<const char*> ids);

/// [main] Nothing for an arm that is not simulated, or whose module cannot be loaded.
std::optional<HandScript> handScriptOf(const scene::Device& device);

/// [main] Warns of strokes beyond half a turn to either side, which were meant in degrees, and of a hand that goes
/// faster than hands go, or so slowly that its times were not meant in s.
document::Problems hastyHands(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
