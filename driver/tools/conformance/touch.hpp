// SPDX-License-Identifier: MIT
/// Finds the places where a shape can be touched, from the answers of the shape. A test that never touches the shape
/// would show nothing.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace hapticd::conformance {

struct Recipe;
class Subject;
struct Answer;

/// A point of the surface over which nothing else of the shape lies.
struct Place {
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();  ///< [m] model frame
  Eigen::Vector3d out = Eigen::Vector3d::Zero();   ///< unit vector from the solid to the free side, model frame
  /// [m] A probe that is deeper than this is pushed out on the other side, because the shape is thin there. 1 m if no
  /// such depth was found.
  double through = 1;
};

/// The result of a search for places on several sides of the shape, for sizes from 1 mm to 1 m.
struct Touch {
  std::vector<Place> places;
  bool traced = false;  ///< true if the shape gave a foot point somewhere
  bool felt = false;    ///< true if the shape gave a force or a torque somewhere
};

/// Follows the foot points that the shape gives, and presses at each to try it. Throws no exception. Returns an empty
/// Touch for a shape that cannot be made.
Touch findTouch(const Recipe& recipe);

/// Writes a Touch as text, to pass it from a child process to its parent, and reads it back.
std::string toText(const Touch& touch);
Touch touchFromText(const std::string& text);

/// One position of a press.
struct PressStep {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< [m]
  bool settled = false;  ///< the probe rests and came straight in, so damping and friction give no force
};

/// Returns how deep [m] a press goes if it begins outside: 1 mm, and less for a small or a thin shape.
double pressDepth(const Subject& subject, const Place& place);

/// Returns how deep [m] a shape is pressed when its depths are examined: 10 mm, and less for a small or a thin shape.
double deepestPress(const Subject& subject, const Place& place);

/// Returns the steps of a press: from outside straight in, once round on a small circle, and out again, without a jump.
std::vector<PressStep> pressAt(const Place& place, double depth);

using PressLook = std::function<std::string(const Answer&, const PressStep&)>;

/// Presses at one place; the first step is a jump. Stops when `look` returns an objection, and returns it; returns ""
/// if there is none.
std::string press(Subject& subject, const Place& place, const PressLook& look);

}  // namespace hapticd::conformance
