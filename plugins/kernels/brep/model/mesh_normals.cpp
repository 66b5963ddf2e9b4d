// SPDX-License-Identifier: MIT
/// Normals of triangle meshes.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/brep/model/groups.hpp"
#include "kernels/brep/model/narrow_triangles.hpp"
#include "kernels/brep/model/topology.hpp"
#include "kernels/contact/edge_rule.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

/// A vector along the normal of a triangle. Its length [m^2] is twice the area.
Vector3d acrossOf(const Part& part, const Triangle& t) {
  const Vector3d a = vec(part.points[t.corner[0]]);
  return (vec(part.points[t.corner[1]]) - a).cross(vec(part.points[t.corner[2]]) - a);
}

/// The angle of a triangle at a corner [rad].
double angleAt(const Part& part, const Triangle& t, std::size_t corner) {
  const Vector3d a = vec(part.points[t.corner[corner]]);
  const Vector3d b = vec(part.points[t.corner[(corner + 1) % 3]]) - a;
  const Vector3d c = vec(part.points[t.corner[(corner + 2) % 3]]) - a;
  return std::atan2(b.cross(c).norm(), b.dot(c));
}

/// Returns smooth_angle [rad] of the body of each triangle.
std::vector<float> anglesOf(const Part& part) {
  std::vector<float> angles(part.triangles.size(), 0);
  for (const Body& body : part.bodies)
    std::fill_n(angles.begin() + body.first_triangle, body.triangle_count, static_cast<float>(body.smooth_angle));
  return angles;
}

/// Joins the corners of two triangles at both ends of their common edge, if the edge is flat enough and has no third
/// triangle.
void joinOverFlatEdges(const Part& part, const std::vector<float>& angles, Groups& groups) {
  for (std::uint32_t i = 0; i < part.triangles.size(); ++i) {
    if (!(angles[i] > 0)) continue;
    const Triangle& t = part.triangles[i];
    const Vector3d n = triangleNormal(part, t);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (t.across[k] == kNone) continue;
      const std::uint32_t other = t.across[k] / 4, m = t.across[k] % 4;
      const Triangle& o = part.triangles[other];
      // the other triangle has handled this edge, or more than two triangles meet there
      if (other <= i || o.across[m] != 4 * i + k) continue;
      if (o.corner[m] != t.corner[(k + 1) % 3]) continue;  // the two triangles have opposite orientations
      const Vector3d no = triangleNormal(part, o);
      if (!(std::atan2(n.cross(no).norm(), n.dot(no)) <= static_cast<double>(angles[i]))) continue;
      groups.join(3 * i + k, 3 * other + (m + 1) % 3);
      groups.join(3 * i + (k + 1) % 3, 3 * other + m);
    }
  }
}

}  // namespace

Vector3d triangleNormal(const Part& part, const Triangle& t) noexcept {
  const Vector3d n = acrossOf(part, t);
  const double length = n.norm();
  return length > 0 ? Vector3d(n / length) : Vector3d::Zero();
}

bool isFlatOver(const Part& part, std::uint32_t triangle, std::uint32_t k) noexcept {
  const std::uint32_t code = part.triangles[triangle].across[k];
  if (code == kNone) return false;
  const Triangle& other = part.triangles[code / 4];
  if (other.across[code % 4] != 4 * triangle + k) return false;
  const Vector3d here = acrossOf(part, part.triangles[triangle]), there = acrossOf(part, other);
  const double most = contact::kSmoothEdge * contact::kSmoothEdge * here.squaredNorm() * there.squaredNorm();
  return here.dot(there) > 0 && here.cross(there).squaredNorm() < most;
}

std::vector<CornerNormal> pointNormals(const Part& part) {
  std::vector<Vector3d> sums(part.points.size(), Vector3d::Zero());
  std::vector<CornerNormal> normals(part.points.size());
  for (std::uint32_t i = 0; i < part.triangles.size(); ++i) {
    const Triangle& t = part.triangles[i];
    const Vector3d n = triangleNormal(part, t);
    const bool narrow = isNarrow(part, i, std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < 3; ++k) {
      sums[t.corner[k]] += angleAt(part, t, k) * n;
      normals[t.corner[k]].narrow |= narrow;
      if (t.across[k] != kNone) continue;
      normals[t.corner[k]].open = normals[t.corner[(k + 1) % 3]].open = true;
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (const double length = sums[i].norm(); length > 0) normals[i].normal = (sums[i] / length).cast<float>();
  return normals;
}

void smoothNormals(const Part& part, std::vector<std::uint32_t>& of_corner, std::vector<Eigen::Vector3f>& normals) {
  of_corner.clear();
  normals.clear();
  const auto smoothed = [](const Body& body) { return body.smooth_angle > 0 && body.triangle_count > 0; };
  if (std::none_of(part.bodies.begin(), part.bodies.end(), smoothed)) return;
  const std::vector<float> angles = anglesOf(part);
  Groups groups(3 * part.triangles.size());
  joinOverFlatEdges(part, angles, groups);
  of_corner.assign(3 * part.triangles.size(), kNone);
  std::vector<Vector3d> sums;
  for (std::uint32_t i = 0; i < part.triangles.size(); ++i) {
    if (!(angles[i] > 0)) continue;
    const Vector3d n = triangleNormal(part, part.triangles[i]);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t root = groups.rootOf(3 * i + k);
      if (of_corner[root] == kNone) {
        of_corner[root] = static_cast<std::uint32_t>(sums.size());
        sums.push_back(Vector3d::Zero());
      }
      of_corner[3 * i + k] = of_corner[root];
      sums[of_corner[root]] += angleAt(part, part.triangles[i], k) * n;
    }
  }
  for (const Vector3d& sum : sums) {
    const double length = sum.norm();
    normals.push_back((length > 0 ? Vector3d(sum / length) : sum).cast<float>());
  }
}

}  // namespace hapticd::brep
