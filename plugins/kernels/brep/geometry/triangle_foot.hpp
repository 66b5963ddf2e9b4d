// SPDX-License-Identifier: MIT
/// The nearest point of a triangle.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace hapticd::brep {

/// Which part of a triangle holds the nearest point.
enum class TriangleRegion : std::uint8_t { kInside, kEdge0, kEdge1, kEdge2, kCorner0, kCorner1, kCorner2 };

struct TriangleFoot {
  Eigen::Vector3d point;
  TriangleRegion region;
  double s, t;  ///< point = a + s (b - a) + t (c - a)
};

/// [rt] Nearest point of the triangle a b c. Edge k runs from corner k to the next.
/// Source: Ericson, Real-Time Collision Detection, 5.1.5 (Voronoi regions of the features).
inline TriangleFoot triangleFoot(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c) noexcept {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, TriangleRegion::kCorner0, 0, 0};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, TriangleRegion::kCorner1, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double s = d1 / (d1 - d3);
    return {a + s * ab, TriangleRegion::kEdge0, s, 0};
  }
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, TriangleRegion::kCorner2, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double t = d2 / (d2 - d6);
    return {a + t * ac, TriangleRegion::kEdge2, 0, t};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {b + w * (c - b), TriangleRegion::kEdge1, 1 - w, w};
  }
  const double scale = 1 / (va + vb + vc), s = vb * scale, t = vc * scale;
  return {a + s * ab + t * ac, TriangleRegion::kInside, s, t};
}

}  // namespace hapticd::brep
