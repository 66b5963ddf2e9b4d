// SPDX-License-Identifier: MIT
#include "kernels/brep/model/narrow_triangles.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/brep/geometry/triangle_foot.hpp"
#include "kernels/brep/model/topology.hpp"

namespace hapticd::brep {

using Eigen::Vector3d;

namespace {

constexpr double kNarrow = 1.0 / 256;  ///< of the longest edge: single precision leaves a part of the direction
constexpr double kShallow = 0.1;       ///< of the distance: what is wider is felt, however thin it is

/// Squared distance from p to the edge from a to b.
double toEdge2(const Vector3d& a, const Vector3d& b, const Vector3d& p) noexcept {
  const double length2 = (b - a).squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0;
  return (a + share * (b - a) - p).squaredNorm();
}

}  // namespace

Hit footOn(const Part& part, std::uint32_t triangle, const Vector3d& p) noexcept {
  const Triangle& t = part.triangles[triangle];
  const TriangleFoot foot =
      triangleFoot(p, vec(part.points[t.corner[0]]), vec(part.points[t.corner[1]]), vec(part.points[t.corner[2]]));
  Hit hit;
  hit.d2 = (p - foot.point).squaredNorm();
  hit.point = foot.point;
  hit.u = foot.s;
  hit.v = foot.t;
  hit.element = Element(ElementKind::kTriangle, triangle);
  hit.region = static_cast<std::uint8_t>(foot.region);
  return hit;
}

bool isNarrow(const Part& part, std::uint32_t triangle, double distance) noexcept {
  const Triangle& t = part.triangles[triangle];
  const Vector3d a = vec(part.points[t.corner[0]]), ab = vec(part.points[t.corner[1]]) - a,
                 ac = vec(part.points[t.corner[2]]) - a;
  const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  const double most2 = std::min(kNarrow * kNarrow * longest2, kShallow * kShallow * distance * distance);
  return ab.cross(ac).squaredNorm() < most2 * longest2;
}

bool isBesideNarrow(const Model& model, std::uint32_t triangle) noexcept {
  if (!model.hasNarrow()) return false;
  const auto& corner = model.part().triangles[triangle].corner;
  return std::any_of(corner.begin(), corner.end(), [&](std::uint32_t i) { return model.pointNormal(i).narrow; });
}

bool looksAlong(const Part& part, std::uint32_t triangle, const Vector3d& normal) noexcept {
  constexpr double kBlade = -0.7;  // cosine: 135 degrees between the normals on both sides
  return triangleNormal(part, part.triangles[triangle]).dot(normal) > kBlade;
}

NearFoot::NearFoot(const Part& part, std::uint32_t triangle, const Vector3d& foot, double distance) noexcept {
  constexpr double kCommon = 1e-6;  // of the distance: a foot on an edge is on the next triangle but for rounding
  const double reach2 = kShallow * kShallow * distance * distance, common2 = kCommon * kCommon * distance * distance;
  found_[count_++] = triangle;
  narrow_[0] = isNarrow(part, triangle, distance);
  for (std::size_t i = 0; i < count_; ++i) {
    const Triangle& t = part.triangles[found_[i]];
    // Over a wide triangle, only what has the foot in common with it is near.
    const double most2 = narrow_[i] ? reach2 : common2;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t next = t.across[k] / 4;
      if (t.across[k] == kNone || count_ == kMost || has(next)) continue;
      const Vector3d a = vec(part.points[t.corner[k]]), b = vec(part.points[t.corner[(k + 1) % 3]]);
      if (!(toEdge2(a, b, foot) <= most2)) continue;
      narrow_[count_] = isNarrow(part, next, distance);
      found_[count_++] = next;
    }
  }
}

bool NearFoot::has(std::uint32_t triangle) const noexcept {
  const auto end = found_.begin() + static_cast<std::ptrdiff_t>(count_);
  return std::find(found_.begin(), end, triangle) != end;
}

bool NearFoot::hasNarrow() const noexcept {
  const auto end = narrow_.begin() + static_cast<std::ptrdiff_t>(count_);
  return std::find(narrow_.begin(), end, true) != end;
}

std::uint32_t NearFoot::nextWide(const Part& part, std::uint32_t triangle, const Vector3d& normal) const noexcept {
  for (std::size_t i = 0; i < count_; ++i)
    if (!narrow_[i] && found_[i] != triangle && looksAlong(part, found_[i], normal)) return found_[i];
  return kNone;
}

Vector3d NearFoot::normalToward(const Part& part, const Vector3d& r) const noexcept {
  constexpr double kSame = 0.99;  // cosine; several triangles of one plane count once
  std::array<Vector3d, kMost> normals;
  std::size_t different = 0;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    if (narrow_[i]) continue;
    const Vector3d n = triangleNormal(part, part.triangles[found_[i]]);
    const auto end = normals.begin() + static_cast<std::ptrdiff_t>(different);
    if (std::any_of(normals.begin(), end, [&](const Vector3d& m) { return m.dot(n) > kSame; })) continue;
    normals[different++] = n;
    sum += n;
  }
  const double length = sum.norm();
  if (!(length > 0)) return sum;
  double least = 1;
  for (std::size_t i = 0; i < different; ++i) least = std::min(least, normals[i].dot(sum) / length);
  // The probe is within the cone of the normals, or behind it. Else a narrow triangle is real, and has the foot.
  const bool within = std::abs(r.dot(sum)) >= (least - (1 - kSame)) * r.norm() * length;
  return least > 1 - kSame && within ? Vector3d(sum / length) : Vector3d::Zero();
}

}  // namespace hapticd::brep
