// SPDX-License-Identifier: MIT
/// The rule for a held contact whose foot comes to an edge between two faces.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace hapticd::contact {

/// How two faces meet, seen from outside the solid.
enum class EdgeKind : std::uint8_t {
  kSmooth,  ///< the normals of both faces agree
  kConvex,  ///< the next face falls away, as at the edge of a table
  kConcave  ///< the next face rises, as a wall from the floor
};

/// [rad] Faces whose normals differ by less than this (0.1 degrees, the tolerance of CAD files) count as one smooth
/// surface.
inline constexpr double kSmoothEdge = 1.8e-3;

/// [any] Returns how two faces meet.
/// @param here, next outward unit normals of the first and the next face at a point of the edge
/// @param out unit vector in the tangent plane of the first face, perpendicular to the edge, away from the face
inline EdgeKind edgeKind(const Eigen::Vector3d& here, const Eigen::Vector3d& next,
                         const Eigen::Vector3d& out) noexcept {
  if (here.dot(next) > 0 && here.cross(next).squaredNorm() < kSmoothEdge * kSmoothEdge) return EdgeKind::kSmooth;
  return next.dot(out) > 0 ? EdgeKind::kConvex : EdgeKind::kConcave;
}

enum class AtEdge : std::uint8_t {
  /// the foot continues on the next face if it comes nearer to the probe there; otherwise it stays on the edge, and
  /// both faces push
  kSlide,
  kRelease  ///< the probe is in front of the next face: it has crossed the edge, and the contact ends
};

/// [any] Decides whether the contact continues when its held foot is on an edge and would move beyond it. The rule of
/// Thompson et al. (1999, 5.2.4) gives the next face. This function returns whether the probe is still in contact
/// there.
/// @param next outward unit normal of the next face
/// @param r vector from the foot to the probe [m]
inline AtEdge atEdge(EdgeKind kind, const Eigen::Vector3d& next, const Eigen::Vector3d& r) noexcept {
  return kind == EdgeKind::kConvex && r.dot(next) >= 0 ? AtEdge::kRelease : AtEdge::kSlide;
}

}  // namespace hapticd::contact
