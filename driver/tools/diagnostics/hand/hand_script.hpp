// SPDX-License-Identifier: MIT
/// Reads the script of a simulated hand from its files: how far, how often and how fast the hand should move.
#pragma once
#include <Eigen/Core>
#include <initializer_list>
#include <optional>
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

struct HandScript {
  enum class Kind { kHold, kStroke, kPress, kTap, kCircle, kPath, kNone, kGuided };  ///< in the module's order
  Kind kind = Kind::kHold;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m] device frame
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< from the centre to the hand, of any length
  double radius = 0, sweep = 0, rise = 0, rate = 0;   ///< [m], [rad], [m], [Hz]
  double lead_in = 0;                                 ///< [s]
  double approach = 0;                                ///< [m] how much farther out than its first aim the hand starts
  double path_end = 0, path_speed = 0, path_fastest_at = 0;  ///< path file: end [s], top speed [m/s], its time [s]
  double path_length = 0;                                    ///< [m] length of that path
  double path_widest = 0;                                    ///< [m] largest coordinate in it
  document::Place path_times;                                ///< where its file has the second time

  /// True if the hand moves by itself: there is a hand, and no program leads it.
  bool moves() const { return kind != Kind::kNone && kind != Kind::kGuided; }
  bool presses() const { return kind == Kind::kPress || kind == Kind::kTap; }
  double speed() const;      ///< [m/s] greatest speed of its motion
  double cycleTime() const;  ///< [s] time in which the hand completes its motion once
};

/// A key of the files that determines the motion of a hand, and its place (file, line and column).
struct HandKey {
  document::Place place;
  std::string id = "hand";
};
/// [main] Returns the first of the keys `ids` that the scene itself gives. If there is none, returns the first that the
/// device file gives; if there is none there either, the place of the arm. If the scene names no device file, its arm
/// is the default arm, whose file belongs to hapticd. The place is then the first line of the scene, because the user
/// can change only the scene.
HandKey keyOfHand(const scene::Scene& scene, const scene::Device& device, std::initializer_list<const char*> ids);

/// [main] Returns the script of an arm's hand; nothing if the arm is not simulated or its module cannot be loaded.
std::optional<HandScript> handScriptOf(const scene::Device& device);

}  // namespace hapticd::diagnostics
