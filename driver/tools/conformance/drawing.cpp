// SPDX-License-Identifier: MIT
/// Compares the drawing that a shape gives by hsp.geometry/1 with what is felt. Nothing else in a run would notice a
/// surface that is drawn at one place and felt at another.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

constexpr size_t kMostTriangles = 96;
constexpr double kDrawnChord = 0.0025, kDrawnReach = 0.005,
                 kDrawnTolerance = 0.02;  // share of the diagonal of the drawing

/// A copy of the triangles, which are valid only until the next call.
struct Drawing {
  std::vector<Vector3d> corners;
  std::vector<std::array<uint32_t, 3>> triangles;
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();  ///< [m] box of the corners

  double diagonal() const { return (high - low).norm(); }
};

/// The differences between the triangles that were tried and the answers of the shape there.
struct Compared {
  size_t seen = 0, away = 0, outward = 0, inward = 0;
  double distance = 0;             ///< [m] distance of the farthest foot point
  Vector3d at = Vector3d::Zero();  ///< [m] the triangle with that foot point
};

/// Copies the arrays. Returns what is wrong with them, or "".
std::string readDrawing(const hsp_mesh& mesh, Drawing& to) {
  if (mesh.vertex_count > 0 && mesh.xyz == nullptr) return "tessellate() counts vertices, and xyz is NULL";
  if (mesh.triangle_count > 0 && mesh.indices == nullptr) return "tessellate() counts triangles, and indices is NULL";
  for (size_t i = 0; i < mesh.vertex_count; ++i) {
    const Vector3d p = Eigen::Map<const Eigen::Vector3f>(mesh.xyz + 3 * i).cast<double>();
    if (!p.allFinite()) return "vertex " + std::to_string(i) + " is not finite";
    to.low = i == 0 ? p : Vector3d(to.low.cwiseMin(p));
    to.high = i == 0 ? p : Vector3d(to.high.cwiseMax(p));
    to.corners.push_back(p);
  }
  for (size_t i = 0; i < mesh.triangle_count; ++i) {
    const std::array<uint32_t, 3> corner{mesh.indices[3 * i], mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]};
    const uint32_t last = *std::max_element(corner.begin(), corner.end());
    if (last >= mesh.vertex_count)
      return "triangle " + std::to_string(i) + " has corner " + std::to_string(last) + ", but there are only " +
             std::to_string(mesh.vertex_count) + " vertices (indices count from 0)";
    to.triangles.push_back(corner);
  }
  return "";
}

/// Returns a text about a corner that lies outside the box, or "".
std::string outsideBounds(const Drawing& drawing, const Vector3d& low, const Vector3d& high) {
  if (!low.allFinite() || !high.allFinite() || (high - low).minCoeff() < 0)
    return "bounds() gives from " + text(low) + " to " + text(high) + "; expected min below max, finite";
  const double room = 1e-3 * drawing.diagonal();  // for the rounding of floats, and for chords of curves
  for (const Vector3d& p : drawing.corners)
    if ((p - low).minCoeff() < -room || (p - high).maxCoeff() > room)
      return "bounds() gives from " + text(low) + " to " + text(high) + ", but tessellate() has a vertex at " +
             text(p) + "; expected a box that holds the model, in m, model frame";
  return "";
}

/// Tries two probes close to one triangle, one before and one behind it: both must find the surface there, and the one
/// behind must be deeper.
void compareTriangle(Subject& subject, const Drawing& drawing, size_t triangle, Compared& to) {
  const auto& corner = drawing.triangles[triangle];
  const Vector3d &a = drawing.corners[corner[0]], &b = drawing.corners[corner[1]], &c = drawing.corners[corner[2]];
  const Vector3d across = (b - a).cross(c - a), middle = (a + b + c) / 3;
  // the triangle has no area, as at a pole
  if (!(across.norm() > 1e-12 * drawing.diagonal() * drawing.diagonal())) return;
  const double reach = kDrawnReach * drawing.diagonal();
  const Vector3d step = reach * across.normalized();
  const hsp_contact before = answerAtRest(subject, middle + step), behind = answerAtRest(subject, middle - step);
  double nearest = HUGE_VAL;
  for (const hsp_contact* contact : {&before, &behind})
    if ((contact->flags & HSP_OUT_TRACED) != 0) nearest = std::min(nearest, (Vector3d(contact->point) - middle).norm());
  if (!std::isfinite(nearest)) return;  // a shape may answer nothing outside of a contact
  ++to.seen;
  if (nearest > kDrawnTolerance * drawing.diagonal()) {
    ++to.away;
    if (nearest > to.distance) to.distance = nearest, to.at = middle;
    return;
  }
  const auto depthOf = [&](const hsp_contact& contact) {
    return (contact.flags & HSP_OUT_TRACED) != 0 ? contact.depth_m : -reach;
  };
  const double deeper = depthOf(behind) - depthOf(before);
  if (deeper > reach / 2) ++to.outward;
  if (deeper < -reach / 2) ++to.inward;  // a difference in between means a thin wall, which is felt from either side
}

std::string verdictOf(const Compared& found) {
  if (2 * found.away > found.seen)
    return std::to_string(found.away) + " of " + std::to_string(found.seen) +
           " triangles that were tried lie away from the surface that is felt: the one at " + text(found.at) + " is " +
           text(found.distance) +
           " m from the foot point there; expected both in m and in the model's frame, none turned or scaled";
  if (found.inward > found.outward)
    return "the triangles are inside out: " + std::to_string(found.inward) + " of " + std::to_string(found.seen) +
           " that were tried have the solid on their front; expected indices counter-clockwise seen from outside";
  return "";
}

}  // namespace

Verdict boundsWhereFelt(const Recipe& recipe, uint64_t) {
  constexpr double kRoom = 0.01;  // share of the diagonal: a curve may lie a little outside of the box of its drawing
  const Made made = madeAtRest(recipe);
  if (!made.error.empty()) return made.error;
  Subject& subject = *made.subject;
  const auto* geometry = static_cast<const hsp_ext_geometry*>(subject.extension(HSP_EXT_GEOMETRY));
  Vector3d low = Vector3d::Zero(), high = low;
  if (geometry == nullptr || geometry->bounds == nullptr ||
      geometry->bounds(subject.handle(), low.data(), high.data()) != HSP_OK)
    return skipped("it gives no bounds() (hsp.geometry/1)");
  const Eigen::AlignedBox3d box(low, high);
  if (!low.allFinite() || !high.allFinite() || box.isEmpty())
    return warned("bounds() gives from " + text(low) + " to " + text(high) + "; expected min below max, finite");
  const Touch touch = recipe.touch.places.empty() ? findTouch(recipe) : recipe.touch;
  double farthest = kRoom * box.diagonal().norm();
  const Place* outside = nullptr;
  for (const Place& place : touch.places)
    if (const double away = box.exteriorDistance(place.foot); away > farthest) farthest = away, outside = &place;
  if (outside == nullptr) return "";
  return warned("bounds() gives from " + text(low) + " to " + text(high) + ", but the surface is felt at " +
                text(outside->foot) + ", " + text(farthest * 1e3) +
                " mm outside; expected a box that holds all of the model, in m, model frame");
}

Verdict drawingWhereFelt(const Recipe& recipe, uint64_t) {
  const Made made = madeAtRest(recipe);
  if (!made.error.empty()) return made.error;
  Subject& subject = *made.subject;
  const auto* geometry = static_cast<const hsp_ext_geometry*>(subject.extension(HSP_EXT_GEOMETRY));
  if (geometry == nullptr || geometry->tessellate == nullptr)
    return skipped("it draws nothing (hsp.geometry/1), so the page of a run shows the arm and the foot point alone");
  Vector3d low = Vector3d::Zero(), high = low;
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  if (geometry->bounds == nullptr || geometry->bounds(subject.handle(), low.data(), high.data()) != HSP_OK)
    return skipped("it gives no bounds()");
  const double chord = kDrawnChord * std::max((high - low).norm(), 1e-6);
  if (geometry->tessellate(subject.handle(), chord, &mesh) != HSP_OK) return skipped("tessellate() gives nothing");
  Drawing drawing;
  if (std::string wrong = readDrawing(mesh, drawing); !wrong.empty()) return wrong;
  if (drawing.triangles.empty()) return skipped("tessellate() gives no triangle");
  if (std::string wrong = outsideBounds(drawing, low, high); !wrong.empty()) return wrong;
  Compared found;
  const size_t tried = std::min(kMostTriangles, drawing.triangles.size());
  constexpr double kGolden = 0.6180339887498949;  // equal steps could try the same column of a grid again and again
  for (size_t i = 0; i < tried; ++i) {
    const double part = std::fmod(kGolden * static_cast<double>(i), 1);
    const auto triangle = static_cast<size_t>(part * static_cast<double>(drawing.triangles.size()));
    compareTriangle(subject, drawing, triangle, found);
  }
  return verdictOf(found);
}

}  // namespace hapticd::conformance
