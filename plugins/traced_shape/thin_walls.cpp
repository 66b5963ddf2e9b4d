// SPDX-License-Identifier: MIT
#include "traced_shape/thin_walls.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/brep/contact/tracer.hpp"
#include "kernels/brep/model/narrow_triangles.hpp"
#include "traced_shape/other_solids.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kPoints = 2000;    ///< most points that are tried
constexpr std::uint32_t kMostOfFace = 32;  ///< most points on one face
/// [m] a point that is farther from the part lies outside the loops of its face
constexpr double kOnSurface = 1e-7;
constexpr double kAbove = 1e-6;  ///< [m] height of the tip over the face before it presses
/// If the cosine between the normals of two faces is greater than this, they bound a wedge and not a wall.
constexpr double kOpposite = -0.7;
constexpr int kHalvings = 20;

/// Returns the i-th point of a sequence that fills a square evenly (Roberts' sequence R2).
Eigen::Array2d evenly(std::uint32_t i) {
  const double u = 0.7548776662466927 * (i + 0.5), v = 0.5698402909980532 * (i + 0.5);
  return {u - std::floor(u), v - std::floor(v)};
}

class WallPress {
 public:
  WallPress(const brep::Model& part, double depth, double least)
      : tracer_(part), others_(part), depth_(depth), least_(least) {}

  /// Presses at a point, given in its body's frame, if it lies on the surface of the part.
  void press(const brep::Placement& place, const Vector3d& in_body) {
    const Vector3d point = place.rotation * in_body + place.position;
    const contact::Foot foot = tracer_.nearest(point);
    if (!contact::found(foot) || foot.distance > kOnSurface || foot.on_edge || !isOf(place, foot)) return;
    if (others_.hold(foot.point + kAbove * foot.normal, place)) return;  // no tip can be there
    const double deepest = wall_ ? wall_->thickness : depth_;
    if (!comesOut(place, foot, deepest)) return;
    double inside = 0, out = deepest;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (inside + out);
      (comesOut(place, foot, middle) ? out : inside) = middle;
    }
    if (out < least_) return;
    wall_ = ThinWall{out, static_cast<std::uint32_t>(foot.surface)};
  }

  const std::optional<ThinWall>& wall() const { return wall_; }

 private:
  /// True if the foot is on this body. If two faces lie on each other, it may be on the other face.
  bool isOf(const brep::Placement& place, const contact::Foot& foot) const {
    const brep::Body& body = tracer_.model().part().bodies[place.body];
    const auto feature = static_cast<std::uint32_t>(foot.surface);
    return feature >= place.first_feature && feature - place.first_feature < body.face_count + body.triangle_count;
  }

  /// True if a probe at this depth below a foot is outside again, behind a face that looks the other way. If another
  /// solid lies close behind, the press continues into that solid.
  bool comesOut(const brep::Placement& place, const contact::Foot& foot, double depth) {
    const Vector3d probe = foot.point - depth * foot.normal;
    const contact::Foot there = tracer_.nearest(probe);
    return contact::found(there) && there.depth < 0 && there.normal.dot(foot.normal) < kOpposite &&
           !others_.hold(probe, place);
  }

  brep::Tracer tracer_;
  OtherSolids others_;
  double depth_, least_;
  std::optional<ThinWall> wall_;
};

/// Presses each face of a placement at some points of its parameter range; points outside the face's loops are left
/// out.
void pressFaces(const brep::Model& part, const brep::Placement& place, std::uint32_t each, std::uint32_t stride,
                WallPress& presser) {
  const brep::Body& body = part.part().bodies[place.body];
  spline::SurfacePoint at;
  for (std::uint32_t f = 0; f < body.face_count; f += stride) {
    const brep::Face& face = part.part().faces[body.first_face + f];
    const Eigen::Array2d lo = brep::vec(face.lo).array(), hi = brep::vec(face.hi).array();
    for (std::uint32_t i = 0; i < each; ++i) {
      const Eigen::Array2d uv = lo + evenly(i) * (hi - lo);
      part.geometry().surface(face.surface, uv[0], uv[1], at);
      presser.press(place, at.S);
    }
  }
}

void pressTriangles(const brep::Model& part, const brep::Placement& place, std::uint32_t stride, WallPress& presser) {
  const brep::Body& body = part.part().bodies[place.body];
  for (std::uint32_t t = 0; t < body.triangle_count; t += stride) {
    // rounding may make a narrow triangle look anywhere, so behind it is no wall
    if (brep::isNarrow(part.part(), body.first_triangle + t, HUGE_VAL)) continue;
    const brep::Triangle& triangle = part.part().triangles[body.first_triangle + t];
    Vector3d middle = Vector3d::Zero();
    for (const std::uint32_t corner : triangle.corner) middle += brep::vec(part.part().points[corner]) / 3;
    presser.press(place, middle);
  }
}

}  // namespace

std::optional<ThinWall> thinnestWall(const brep::Model& part, double depth, double least) {
  if (!(depth > kOnSurface) || !std::isfinite(depth)) return std::nullopt;
  std::uint64_t count = 0;
  for (const brep::Placement& place : part.placements()) {
    const brep::Body& body = part.part().bodies[place.body];
    if (place.solid) count += std::uint64_t{body.face_count} + body.triangle_count;
  }
  if (count == 0) return std::nullopt;
  const auto each = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kPoints / count, 1, kMostOfFace));
  const auto stride = static_cast<std::uint32_t>((count + kPoints - 1) / kPoints);
  WallPress presser(part, depth, least);
  for (const brep::Placement& place : part.placements()) {
    if (!place.solid) continue;
    pressFaces(part, place, each, stride, presser);
    pressTriangles(part, place, stride, presser);
  }
  return presser.wall();
}

}  // namespace hapticd
