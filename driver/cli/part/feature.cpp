// SPDX-License-Identifier: MIT
#include "cli/part/feature.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

#include "kernels/brep/model/model.hpp"
#include "kernels/part/names.hpp"

namespace hapticd::cli {
namespace {

using brep::Model;
using brep::SurfaceKind;
using Eigen::Vector3d;

constexpr double kMm = 1e3;

std::string pointText(const Vector3d& p, double unit) {
  const auto rounded = [unit](double x) { return std::round(unit * x * 1e6) * 1e-6 + 0.0; };
  char text[100];
  std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", rounded(p.x()), rounded(p.y()), rounded(p.z()));
  return text;
}

std::string kindText(const brep::Surface& surface) {
  constexpr const char* kNames[] = {"a plane",  "a cylinder",   "a cone",       "a sphere", "a torus",
                                    "a spline", "an extrusion", "a revolution", "an offset"};
  char text[80] = "";
  if (surface.kind == SurfaceKind::kCylinder || surface.kind == SurfaceKind::kSphere)
    std::snprintf(text, sizeof text, " of radius %.4g mm", kMm * surface.r[0]);
  if (surface.kind == SurfaceKind::kTorus)
    std::snprintf(text, sizeof text, " of radii %.4g and %.4g mm", kMm * surface.r[0], kMm * surface.r[1]);
  return std::string(kNames[static_cast<std::size_t>(surface.kind)]) + text;
}

/// Adds points on the edges of a face to a box.
void addEdges(const Model& model, const brep::Placement& place, const brep::Face& face, Eigen::AlignedBox3d& box) {
  constexpr int kPieces = 16;
  const brep::Part& part = model.part();
  spline::CurvePoint at;
  for (std::uint32_t l = face.first_loop; l < face.first_loop + face.loop_count; ++l)
    for (std::uint32_t c = part.loops[l].first; c < part.loops[l].first + part.loops[l].count; ++c) {
      const brep::Edge& edge = part.edges[part.coedges[c].edge];
      if (edge.curve == brep::kNone) continue;
      for (int i = 0; i <= kPieces; ++i) {
        model.geometry().curve(edge.curve, edge.t0 + (edge.t1 - edge.t0) * i / kPieces, at);
        box.extend(place.rotation * at.C + place.position);
      }
    }
}

/// Adds points between the loops of a face to a box.
void addInside(const Model& model, const brep::Placement& place, std::uint32_t index, Eigen::AlignedBox3d& box) {
  constexpr int kPieces = 32;
  const brep::Face& face = model.part().faces[index];
  spline::SurfacePoint at;
  for (int i = 0; i < (kPieces + 1) * (kPieces + 1); ++i) {
    const int column = i % (kPieces + 1), row = i / (kPieces + 1);
    const double u = face.lo[0] + (face.hi[0] - face.lo[0]) * column / kPieces;
    const double v = face.lo[1] + (face.hi[1] - face.lo[1]) * row / kPieces;
    if (!model.face(index).trim.inside(u, v)) continue;
    model.geometry().surface(face.surface, u, v, at);
    box.extend(place.rotation * at.S + place.position);
  }
}

std::string listed(const Vector3d& v) {
  const auto rounded = [](double x) { return std::round(x * 1e9) * 1e-9 + 0.0; };
  char text[100];
  std::snprintf(text, sizeof text, "[%.9g, %.9g, %.9g]", rounded(v.x()), rounded(v.y()), rounded(v.z()));
  return text;
}

/// An axis in the frame of the part: a point [m] and a unit vector.
struct Axis {
  Vector3d through = Vector3d::Zero(), along = Vector3d::Zero();

  std::string keys() const { return "joint: hinge, pivot: " + listed(through) + ", axis: " + listed(along); }

  bool same(const Axis& other) const {
    constexpr double kNear = 1e-6, kTurned = 1e-6;  // [m], [rad]
    const Vector3d way = other.through - through;
    return along.cross(other.along).norm() < kTurned && (way - way.dot(along) * along).norm() < kNear;
  }
};

/// Returns the axis of a round face, nothing for other faces. @param near [m] the axis is described at its point
/// nearest to this
std::optional<Axis> axisOf(const brep::Surface& surface, const brep::Placement& place, const Vector3d& near) {
  const bool round = surface.kind == SurfaceKind::kCylinder || surface.kind == SurfaceKind::kCone ||
                     surface.kind == SurfaceKind::kTorus || surface.kind == SurfaceKind::kRevolution;
  if (!round) return {};
  const Vector3d origin = place.rotation * brep::vec(surface.o) + place.position;
  const Vector3d along = (place.rotation * brep::vec(surface.z)).normalized();
  return Axis{origin + along.dot(near - origin) * along, along};
}

/// Returns where the axis of a round face is, and the keys of a scene that let a body turn about it; the centre of a
/// sphere; "" for other faces.
std::string axisText(const brep::Surface& surface, const brep::Placement& place, const Vector3d& near) {
  if (surface.kind == SurfaceKind::kSphere)
    return ", centre at " + pointText(place.rotation * brep::vec(surface.o) + place.position, kMm) + " mm";
  const auto axis = axisOf(surface, place, near);
  if (!axis) return "";
  return ", axis through " + pointText(axis->through, kMm) + " mm along " + pointText(axis->along, 1) +
         "\n  to turn about it in a scene:    " + axis->keys();
}

/// Returns a box around a face in its place [m].
Eigen::AlignedBox3d boxOf(const Model& model, const brep::Placement& place, std::uint32_t index) {
  Eigen::AlignedBox3d box;
  addEdges(model, place, model.part().faces[index], box);
  addInside(model, place, index, box);
  return box;
}

std::string faceText(const Model& model, const brep::Placement& place, std::uint32_t index) {
  const brep::Face& face = model.part().faces[index];
  const Eigen::AlignedBox3d box = boxOf(model, place, index);
  std::string text = kindText(model.part().surfaces[face.surface]);
  if (model.part().surfaces[face.surface].kind == SurfaceKind::kPlane) {
    const Vector3d normal = model.geometry().normal(face, 0.5 * (brep::vec(face.lo) + brep::vec(face.hi)));
    const double side = (face.flags & brep::kReversed) != 0 ? -1 : 1;
    text += " that looks along " + pointText(side * (place.rotation * normal), 1);
  }
  if (box.isEmpty()) return text;
  char size[100];
  const Vector3d sizes = (box.sizes() * kMm * 1e6).array().round() * 1e-6;  // 1e-14 mm of a plane is rounding
  std::snprintf(size, sizeof size, ", %.4g x %.4g x %.4g mm large", sizes.x(), sizes.y(), sizes.z());
  return text + size + ", middle at " + pointText(box.center(), kMm) + " mm" +
         axisText(model.part().surfaces[face.surface], place, box.center());
}

std::string triangleText(const Model& model, const brep::Placement& place, std::uint32_t index) {
  std::string text = "corners at ";
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d corner = brep::vec(model.part().points[model.part().triangles[index].corner[k]]);
    text += (k == 0 ? "" : ", ") + pointText(place.rotation * corner + place.position, kMm);
  }
  return text + " mm";
}

/// The faces about one axis. Those of one kind and size are named together.
struct RoundFaces {
  Axis axis;
  std::vector<std::pair<std::string, std::vector<std::uint32_t>>> features;  ///< of each kind

  void add(const std::string& kind, std::uint32_t feature) {
    auto same = std::find_if(features.begin(), features.end(), [&](const auto& one) { return one.first == kind; });
    if (same == features.end()) same = features.insert(same, {kind, {}});
    same->second.push_back(feature);
  }

  std::string text() const {
    std::string text;
    for (const auto& [kind, numbers] : features) {
      text += (text.empty() ? "" : "; ") + kind + (numbers.size() > 1 ? ": features " : ": feature ");
      for (std::size_t i = 0; i < numbers.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
    }
    return text;
  }
};

}  // namespace

std::optional<std::uint32_t> featureCalled(const brep::Part& part, const std::string& asked) {
  std::uint32_t number = 0;
  const char* end = asked.data() + asked.size();
  const auto read = std::from_chars(asked.data(), end, number);
  const bool is_number = read.ptr == end && read.ec == std::errc();
  if (is_number) return brep::featureName(part, number).empty() ? std::nullopt : std::optional(number);
  for (std::uint32_t i = 0;; ++i) {
    const std::string name = brep::featureName(part, i);
    if (name.empty()) return {};
    if (("/" + name + " '").find("/" + asked + " '") != std::string::npos) return i;  // "face 3" may have a name
  }
}

std::string featureText(const brep::Part& part, std::uint32_t feature) {
  const Model model{brep::Part(part)};
  for (const brep::Placement& place : model.placements()) {
    const brep::Body& body = model.part().bodies[place.body];
    if (feature < place.first_feature) continue;
    const std::uint32_t at = feature - place.first_feature;
    if (at < body.face_count) return faceText(model, place, body.first_face + at);
    if (at - body.face_count < body.triangle_count)
      return triangleText(model, place, body.first_triangle + at - body.face_count);
  }
  return "";
}

std::vector<std::string> axisLines(const brep::Part& part) {
  const Model model{brep::Part(part)};
  std::vector<std::string> all;
  for (const brep::Placement& place : model.placements()) {
    const brep::Body& body = model.part().bodies[place.body];
    std::vector<RoundFaces> axes;  // of this instance
    for (std::uint32_t i = 0; i < body.face_count; ++i) {
      const std::uint32_t index = body.first_face + i;
      const brep::Surface& surface = model.part().surfaces[model.part().faces[index].surface];
      if (!axisOf(surface, place, Vector3d::Zero())) continue;
      const Eigen::AlignedBox3d box = boxOf(model, place, index);
      const auto axis = axisOf(surface, place, box.isEmpty() ? Vector3d(place.position) : Vector3d(box.center()));
      if (!axis) continue;
      auto known = std::find_if(axes.begin(), axes.end(), [&](const RoundFaces& one) { return one.axis.same(*axis); });
      if (known == axes.end()) known = axes.insert(known, {*axis, {}});
      known->add(kindText(surface), place.first_feature + i);
    }
    for (const RoundFaces& faces : axes)
      all.push_back(brep::instancePath(part, place.instance) + ": " + faces.axis.keys() + "  (" + faces.text() + ")");
  }
  return all;
}

}  // namespace hapticd::cli
