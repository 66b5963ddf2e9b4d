// SPDX-License-Identifier: MIT
#include "diagnostics/scene/overlapping_models.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "diagnostics/reading/key_place.hpp"
#include "diagnostics/scene/value_plausibility.hpp"
#include "kernels/brep/geometry/triangle_foot.hpp"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

constexpr double kChord = 2e-4;         ///< [m] error of the triangles
constexpr double kOverlap = 1e-3;       ///< [m] smaller overlaps are not reported
constexpr size_t kMostModels = 64;      ///< in larger scenes nothing is judged
constexpr size_t kMostTriangles = 2e4;  ///< larger models are left out, because each point is compared with all of them
constexpr size_t kMostTests = 3e7;      ///< points times triangles, of all pairs together

struct Triangle {
  Vector3d a, b, c;
};

/// The surface of one model in the world, as triangles.
struct Solid {
  std::vector<Triangle> triangles;
  std::vector<Vector3d> points;  ///< [m] a sample of the surface
  Eigen::AlignedBox3d box;
};

scene::Pose startOf(const scene::Model& model) {
  return model.kinematic && !model.path.empty() ? model.path.front().pose : model.pose;
}

/// Takes about `kPoints` points of the triangles: corners and middles, and more of large triangles.
void samplePoints(Solid& solid) {
  constexpr size_t kPoints = 400;
  const size_t count = solid.triangles.size(), every = std::max<size_t>(1, 3 * count / kPoints);
  const int parts = std::clamp(static_cast<int>(std::sqrt(2.0 * kPoints / static_cast<double>(count))), 1, 20);
  for (size_t i = 0; i < count; i += every) {
    const Triangle& t = solid.triangles[i];
    for (int u = 0; u <= parts; ++u)
      for (int v = 0; u + v <= parts; ++v)
        solid.points.push_back(t.a + (t.b - t.a) * u / parts + (t.c - t.a) * v / parts);
  }
}

/// Returns a box round a model in the world; an empty one if the model gives none.
Eigen::AlignedBox3d boxOf(const scene::Model& model, const host::ShapeInstance& shape) {
  Eigen::AlignedBox3d own, box;
  if (!shape.bounds(own.min().data(), own.max().data())) return box;
  const scene::Pose pose = startOf(model);
  for (int i = 0; i < 8; ++i)
    box.extend(pose.position + pose.orientation * own.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  return box;
}

Solid solidOf(const scene::Model& model, const host::ShapeInstance& shape) {
  Solid solid;
  constexpr double kBack = 1, kBoth = 2;  // values of `sides`: a cavity, and a shell, are not filled
  if (const double sides = numberIn(model.parameters, "sides"); sides == kBack || sides == kBoth) return solid;
  const bool rigid = (shape.description().flags & HSP_C_DEFORMS) == 0 && (shape.report().flags & HSP_R_MOVES) == 0;
  hsp_mesh mesh{};
  if (!rigid || shape.geometry() == nullptr || shape.tessellate(kChord, mesh) < 0) return solid;
  if (mesh.triangle_count > kMostTriangles || mesh.triangle_count == 0) return solid;
  const scene::Pose pose = startOf(model);
  const auto corner = [&](uint32_t index) {
    const float* xyz = mesh.xyz + 3 * size_t{mesh.indices[index]};
    const Vector3d p = pose.position + pose.orientation * Vector3d(xyz[0], xyz[1], xyz[2]);
    solid.box.extend(p);
    return p;
  };
  for (uint32_t i = 0; i < mesh.triangle_count; ++i) {
    const Vector3d a = corner(3 * i), b = corner(3 * i + 1), c = corner(3 * i + 2);
    solid.triangles.push_back({a, b, c});
  }
  samplePoints(solid);
  return solid;
}

/// Returns how often a closed surface goes round a point: 1 inside, 0 outside, and something between for an open one.
double windings(const Solid& solid, const Vector3d& p) {
  double angle = 0;
  for (const Triangle& t : solid.triangles) {
    const Vector3d a = t.a - p, b = t.b - p, c = t.c - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * M_PI);
}

/// Returns the greatest depth [m] of the points of one solid in another.
double depthIn(const Solid& inner, const Solid& outer, size_t& tests) {
  constexpr double kInside = 0.9;
  double deepest = 0;
  for (const Vector3d& p : inner.points) {
    if (!outer.box.contains(p) || tests + outer.triangles.size() > kMostTests) continue;
    tests += outer.triangles.size();
    double depth = std::numeric_limits<double>::max();
    for (const Triangle& t : outer.triangles)
      depth = std::min(depth, (brep::triangleFoot(p, t.a, t.b, t.c).point - p).norm());
    if (depth > std::max(deepest, kOverlap) && windings(outer, p) > kInside) deepest = depth;
  }
  return deepest;
}

/// Returns what equal shapes have in common: the plugin and its file.
std::string shapeNameOf(const scene::Model& model) {
  const scene::Value* geometry = givenIn(model.parameters, "geometry");
  return geometry != nullptr ? model.plugin + " " + geometry->text : model.plugin;
}

/// Returns true for two models of a row of equal shapes, which often run into one another on purpose.
bool areOfOneRow(const scene::Scene& scene, size_t first, size_t second) {
  constexpr long kRow = 4;
  const std::string shape = shapeNameOf(scene.models[first]);
  return shape == shapeNameOf(scene.models[second]) &&
         std::count_if(scene.models.begin(), scene.models.end(),
                       [&](const scene::Model& model) { return shapeNameOf(model) == shape; }) >= kRow;
}

bool inOneGroup(const std::vector<std::vector<size_t>>& groups, size_t a, size_t b) {
  const auto holds = [](const std::vector<size_t>& group, size_t model) {
    return std::find(group.begin(), group.end(), model) != group.end();
  };
  return std::any_of(groups.begin(), groups.end(),
                     [&](const std::vector<size_t>& group) { return holds(group, a) && holds(group, b); });
}

}  // namespace

document::Problems overlappingModels(const scene::Scene& scene, const servo::World& world) {
  document::Problems warnings;
  if (scene.models.size() < 2 || scene.models.size() > kMostModels) return warnings;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (size_t i = 0; i < scene.models.size(); ++i) boxes.push_back(boxOf(scene.models[i], *world.shapes()[i]));
  const auto told = modelsInOnePlace(scene);  // these have a warning of their own
  std::map<size_t, Solid> solids;             // only of models whose boxes meet, because triangles take time
  const auto solid = [&](size_t i) -> const Solid& {
    const auto found = solids.find(i);
    return found != solids.end() ? found->second
                                 : solids.emplace(i, solidOf(scene.models[i], *world.shapes()[i])).first->second;
  };
  size_t tests = 0;
  for (size_t second = 1; second < boxes.size(); ++second)
    for (size_t first = 0; first < second; ++first) {
      if (!boxes[first].intersects(boxes[second]) || inOneGroup(told, first, second)) continue;
      if (areOfOneRow(scene, first, second) || !scene.models[first].enabled || !scene.models[second].enabled) continue;
      const double depth =
          std::max(depthIn(solid(second), solid(first), tests), depthIn(solid(first), solid(second), tests));
      if (depth <= kOverlap) continue;
      const scene::Model &one = scene.models[first], &other = scene.models[second];
      std::string key = fmt::format("models[{}].{}", second, other.path.empty() ? "pose.position" : "path");
      const auto place = placeOfKey(other.place.file, key);
      if (!place) key = fmt::format("models[{}].pose", second);
      document::report(warnings, place.value_or(other.place), key,
                       fmt::format("{} and {} (line {}) lie in one another at the start, {:.2g} mm deep, so a hand "
                                   "there feels the sum of both; move one of them",
                                   other.name, one.name, one.place.line, depth * 1e3));
    }
  return warnings;
}

}  // namespace hapticd::diagnostics
