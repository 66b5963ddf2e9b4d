// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hand_inside.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string>

namespace hapticd::diagnostics {
namespace {

/// Warns of surfaces that face the wrong way: the tip is not between them, and yet counts as inside.
void reportTurned(const scene::Scene& scene, const InsideTip& inside, const std::string& where,
                  document::Problems& warnings) {
  const scene::Model& model = scene.models[inside.model];
  const scene::Value *sides = givenIn(model.parameters, "sides"), *geometry = givenIn(model.parameters, "geometry");
  const scene::Value* at = sides != nullptr ? sides : geometry;
  const std::string key = fmt::format("models[{}]", inside.model);
  document::report(warnings, at != nullptr ? at->place : model.place,
                   at != nullptr ? key + ".parameters." + at->id : key + ".pose",
                   fmt::format("{}, though it is outside the box round the surfaces: the hand meets them from their "
                               "other side; expected {}, or a hand on their other side",
                               where,
                               sides != nullptr ? "another value of sides"
                                                : "surfaces that face the hand: outward: reversed, or v fastest in "
                                                  "points, in the file, or sides: both"));
}

/// Returns the centre of the hand's script in the frame of the model.
Eigen::Vector3d centerInModel(const scene::Device& device, const HandScript& hand, const scene::Model& model) {
  const Eigen::Vector3d center = device.mount.position + device.mount.orientation * hand.center;
  return model.pose.orientation.conjugate() * (center - model.pose.position);
}

}  // namespace

double ballOf(const scene::Model& model) {
  return numberIn(model.parameters, "tip_radius");
}

bool circlesModel(const scene::Device& device, const HandScript& hand, const scene::Model& model,
                  const host::ShapeInstance& shape) {
  Eigen::AlignedBox3d box;
  if (!shape.bounds(box.min().data(), box.max().data())) return false;
  return box.contains(centerInModel(device, hand, model));
}

bool passesAround(const scene::Device& device, const HandScript& hand, const scene::Model& model,
                  const host::ShapeInstance& shape) {
  Eigen::AlignedBox3d box;
  if (!shape.bounds(box.min().data(), box.max().data())) return false;
  const Eigen::Vector3d center = centerInModel(device, hand, model);
  return (box.min() - center).cwiseAbs().cwiseMax((box.max() - center).cwiseAbs()).norm() < hand.radius;
}

void reportInside(const scene::Scene& scene, const InsideTip& inside, document::Problems& warnings) {
  const scene::Model& model = scene.models[inside.model];
  const scene::Device& device = scene.devices[inside.device];
  const double ball = ballOf(model);
  const std::string where = fmt::format(
      "the hand starts inside {}: the tip is at [{:.4g}, {:.4g}, {:.4g}] m in the world, {}{:.3g} mm deep", model.name,
      inside.tip.x(), inside.tip.y(), inside.tip.z(),
      ball > 0 ? fmt::format("and a ball of {:.3g} mm about it (tip_radius) is ", ball * 1e3) : "", inside.depth * 1e3);
  if (inside.beyond_box) return reportTurned(scene, inside, where, warnings);
  const scene::Value* radius = givenIn(device.parameters, "hand.radius");
  if (inside.radius && radius != nullptr && radius->place.file == scene.file.string())
    return document::report(warnings, radius->place, "hand.radius",
                            fmt::format("{}; expected a hand.radius of {:.4g} m, with which it starts outside (it is "
                                        "{:.4g} m now), or another place of the model or the arm (mount)",
                                        where, *inside.radius, radius->number));
  document::report(warnings, model.place, fmt::format("models[{}].pose", inside.model),
                   where + "; expected a start outside: move the model, the arm (mount) or the hand (hand)");
}

}  // namespace hapticd::diagnostics
