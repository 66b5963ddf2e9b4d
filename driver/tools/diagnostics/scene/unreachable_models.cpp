// SPDX-License-Identifier: MIT
#include "diagnostics/scene/unreachable_models.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "diagnostics/reading/far_limits.hpp"
#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/nearest_model.hpp"
#include "servo/loop/lockstep.hpp"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

/// Returns whether a model stays in its place: neither its plugin, nor a path, nor a program moves it.
bool rests(const scene::Model& model, const host::ShapeInstance& shape) {
  return !model.kinematic && (shape.report().flags & HSP_R_MOVES) == 0;
}

struct EnclosedModel {
  size_t inner = 0, outer = 0;
  Vector3d center = Vector3d::Zero();  ///< [m] centre of the box of the inner model, world frame
  double radius = 0;                   ///< [m] of a sphere about the inner model
  double width = 0;                    ///< [m] diagonal of the box of the outer model
};

/// Returns a model whose box lies inside the box of another model. The other model may be hollow there.
std::optional<EnclosedModel> mayEnclose(const scene::Scene& scene, const servo::World& world, size_t inner,
                                        size_t outer) {
  const host::ShapeInstance &small = *world.shapes()[inner], &large = *world.shapes()[outer];
  if (inner == outer || !rests(scene.models[inner], small) || !rests(scene.models[outer], large)) return std::nullopt;
  if ((large.description().flags & HSP_C_DEFORMS) != 0 || !(large.report().max_stiffness > 0)) return std::nullopt;
  Eigen::AlignedBox3d box, about;
  if (!small.bounds(box.min().data(), box.max().data()) || !large.bounds(about.min().data(), about.max().data()))
    return std::nullopt;
  const scene::Pose &pose = scene.models[inner].pose, &frame = scene.models[outer].pose;
  const Vector3d center = pose.position + pose.orientation * box.center();
  const Vector3d within = frame.orientation.conjugate() * (center - frame.position);
  const double radius = 0.5 * box.diagonal().norm();
  if (!about.contains(within) || 2 * radius > about.sizes().minCoeff()) return std::nullopt;
  return EnclosedModel{inner, outer, center, radius, about.diagonal().norm()};
}

/// Returns the depth in m of the inner model's centre in the outer model. A probe in a scene with the outer model alone
/// measures it.
double depthIn(const scene::Scene& scene, const EnclosedModel& found) {
  scene::Scene alone = scene;
  alone.models = {scene.models[found.outer]};
  alone.servo.activation_radius = std::max(alone.servo.activation_radius, found.width);
  auto world =
      servo::World::build(alone, {.rate = scene.servo.rate}, [](int, const std::string&, const std::string&) {});
  if (!world) return 0;
  std::vector<servo::Probe> probes(1);
  probes[0].valid = true;
  probes[0].position = found.center;
  servo::Lockstep lockstep = (*world)->lockstep();
  (*world)->core().publish(0, probes);
  lockstep.before(0);
  (*world)->core().tick(0, 0, probes);
  const servo::Contact& contact = (*world)->core().contact(0, 0);
  return contact.traced ? contact.world.depth_m : 0;
}

/// Returns how far a model stays beyond the reach of all arms, anywhere on its path [m]; 0 or less if one reaches it.
double missedByPath(const scene::Model& model, const host::ShapeInstance& shape, const std::vector<TipReach>& tips,
                    double room) {
  Eigen::AlignedBox3d box;
  if (model.path.empty() || tips.empty() || !shape.bounds(box.min().data(), box.max().data())) return 0;
  double least = std::numeric_limits<double>::max();
  for (const scene::PathPoint& point : model.path)
    for (const TipReach& tip : tips) {
      const Vector3d center = point.pose.position + point.pose.orientation * box.center();
      least = std::min(least, (center - tip.tip).norm() - 0.5 * box.diagonal().norm() - room * tip.reach);
    }
  return least;
}

}  // namespace

document::Problems unreachableModels(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                     const std::vector<TipReach>& tips) {
  constexpr double kRoom = 1.1;     // not all poses of the arm were tried
  constexpr double kLittle = 0.05;  // [m] a model that is missed by less is not reported
  document::Problems warnings;
  for (uint32_t i = 0; i < scene.models.size(); ++i) {
    if (const double missed = missedByPath(scene.models[i], *world.shapes()[i], tips, kRoom) - kLittle; missed > 0)
      document::report(warnings, scene.models[i].place, fmt::format("models[{}].path", i),
                       fmt::format("no arm reaches {} anywhere on its path: the nearest arm ends about {:.3g} m before "
                                   "it; the path gives places in the world, in m",
                                   scene.models[i].name, missed));
    const auto isFar = [&](const scene::Device& device) {
      return (scene.models[i].pose.position - device.mount.position).norm() >
             kFarModel;  // these have their own warning
    };
    if (!rests(scene.models[i], *world.shapes()[i]) || std::all_of(scene.devices.begin(), scene.devices.end(), isFar))
      continue;
    std::optional<double> least;      // [m] from the model to the nearest place that an arm reaches
    Vector3d end = Vector3d::Zero();  // [m] about this place, in the world
    for (uint32_t tip = 0; tip < tips.size(); ++tip) {
      const auto away = distanceOf(scene, world, core, i, tips[tip].tip, tip);
      const double missing = away ? *away - kRoom * tips[tip].reach - kLittle : 0;
      if (least && *least <= missing) continue;
      least = missing;
      end = tips[tip].tip + (scene.models[i].pose.position - tips[tip].tip).normalized() * tips[tip].reach;
    }
    if (least && *least > 0)
      reportInModel(warnings, scene, i, "pose.position",
                    fmt::format("no arm reaches {}: the nearest arm ends about {:.3g} m before it, at about [{:.2f}, "
                                "{:.2f}, {:.2f}] in the world; move the model there (pose.position, in m) or the arm "
                                "(mount.position of its device)",
                                scene.models[i].name, *least, end.x(), end.y(), end.z()));
  }
  return warnings;
}

document::Problems enclosedModels(const scene::Scene& scene, const servo::World& world) {
  constexpr size_t kMost = 4;         // pairs that are tried, because each sets up a model again
  constexpr double kPressed = 0.005;  // [m] no hand presses deeper
  document::Problems warnings;
  size_t tried = 0;
  for (size_t inner = 0; inner < scene.models.size(); ++inner)
    for (size_t outer = 0; outer < scene.models.size(); ++outer) {
      if (!scene.models[inner].enabled || !scene.models[outer].enabled) continue;  // they are felt by turns
      const auto found = mayEnclose(scene, world, inner, outer);
      if (!found || tried++ >= kMost) continue;
      const double depth = depthIn(scene, *found);
      if (depth < found->radius + kPressed) continue;
      reportInModel(
          warnings, scene, inner, "pose.position",
          fmt::format("{} lies within {}, {:.3g} mm below its surface, so no hand touches it; move it outside",
                      scene.models[inner].name, scene.models[outer].name, (depth - found->radius) * 1e3));
      break;
    }
  return warnings;
}

}  // namespace hapticd::diagnostics
