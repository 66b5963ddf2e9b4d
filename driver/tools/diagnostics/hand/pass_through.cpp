// SPDX-License-Identifier: MIT
#include "diagnostics/hand/pass_through.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnostics/hand/hand_script.hpp"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

/// The part of a straight way that lies within a box, as distances [m] from its start.
struct Inside {
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
};

Inside insideOf(const Eigen::AlignedBox3d& box, const Vector3d& start, const Vector3d& way) {
  Inside inside;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis] - start[axis], high = box.max()[axis] - start[axis];
    if (std::abs(way[axis]) < 1e-9) {
      if (low > 0 || high < 0) return {1, 0};
      continue;
    }
    inside.from = std::max(inside.from, std::min(low / way[axis], high / way[axis]));
    inside.to = std::min(inside.to, std::max(low / way[axis], high / way[axis]));
  }
  return inside;
}

/// Returns where the way of a hand lies in the box of a model, in distances from where its press begins.
Inside wayInside(const scene::Device& device, const HandScript& hand, const scene::Model& model,
                 const Eigen::AlignedBox3d& box) {
  const Vector3d inwards = -hand.normal.normalized(), aim = hand.center - hand.radius * inwards;
  const Eigen::Quaterniond back = model.pose.orientation.conjugate();
  const Vector3d start = back * (device.mount.position + device.mount.orientation * aim - model.pose.position);
  return insideOf(box, start, back * (device.mount.orientation * inwards));
}

/// Returns true if the hand meets a body that gives way. How far the hand goes then depends on the body, and the box of
/// a housing around it says nothing about the way.
bool meetsAMovingBody(const scene::Scene& scene, const ModelBoxes& boxes, const std::vector<bool>& moves,
                      const scene::Device& device, const HandScript& hand) {
  for (size_t i = 0; i < scene.models.size() && i < boxes.size(); ++i) {
    if (!boxes[i] || i >= moves.size() || !moves[i]) continue;
    const Inside inside = wayInside(device, hand, scene.models[i], *boxes[i]);
    if (inside.from < inside.to && inside.to >= 0 && inside.from <= hand.rise) return true;
  }
  return false;
}

}  // namespace

document::Problems pressesThrough(const scene::Scene& scene, const ModelBoxes& boxes, const std::vector<bool>& moves) {
  document::Problems warnings;
  for (const scene::Device& device : scene.devices) {
    const auto hand = handScriptOf(device);
    if (!hand || !hand->presses() || !(hand->normal.norm() > 0)) continue;
    if (meetsAMovingBody(scene, boxes, moves, device, *hand)) continue;
    for (size_t i = 0; i < scene.models.size() && i < boxes.size(); ++i) {
      const scene::Model& model = scene.models[i];
      if (!boxes[i] || model.kinematic || (i < moves.size() && moves[i])) continue;
      const Inside inside = wayInside(device, *hand, model, *boxes[i]);
      // [m] A hand that aims at the far end of the box presses a sheet there: an open shell has no back out of which
      // the hand could come.
      constexpr double kBehind = 1e-4;
      if (!(inside.from < inside.to) || inside.to < kBehind || hand->rise <= inside.to) continue;
      const HandKey key = keyOfHand(scene, device, {"hand.rise", "hand.radius", "hand.script"});
      document::report(warnings, key.place, key.id,
                       fmt::format("the hand of {} goes {:.4g} m inwards, and {} ends {:.4g} m inwards (it is {:.4g} m "
                                   "thick there): the hand comes out behind it; the value must be in m (5 mm is 0.005)",
                                   device.name, hand->rise, model.name, inside.to, inside.to - inside.from));
      break;
    }
  }
  return warnings;
}

}  // namespace hapticd::diagnostics
