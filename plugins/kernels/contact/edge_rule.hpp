// SPDX-License-Identifier: MIT
/// What a held contact does when its foot comes to an edge between two faces.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace hapticd::contact {

/// How two faces meet, seen from where the solid is not.
enum class EdgeKind : std::uint8_t {
  kSmooth,  ///< their normals agree
  kConvex,  ///< the next face falls away: the edge of a table
  kConcave  ///< the next face rises, as a wall does from the floor
};

/// [rad] Faces whose normals differ by less are one smooth surface: 0.1 degrees, as CAD files need it.
inline constexpr double kSmoothEdge = 1.8e-3;

/// [any] @param here, next outward unit normals of the two faces at a point of the edge @param out unit, in the plane
/// of the first face, at right angles to the edge and away from the face
inline EdgeKind edgeKind(const Eigen::Vector3d& here, const Eigen::Vector3d& next,
                         const Eigen::Vector3d& out) noexcept {
  if (here.dot(next) > 0 && here.cross(next).squaredNorm() < kSmoothEdge * kSmoothEdge) return EdgeKind::kSmooth;
  return next.dot(out) > 0 ? EdgeKind::kConvex : EdgeKind::kConcave;
}

enum class AtEdge : std::uint8_t {
  kSlide,   ///< continues on the next face if that is nearer to the probe, else stays: both faces push
  kRelease  ///< the probe is in front of the next face: it crossed the edge, and the contact ends
};

/// [any] A held foot is on an edge and would continue beyond it. The paper's rule (Thompson et al. 1999, 5.2.4) says
/// which face comes next; this says whether the probe is still in contact there. @param r from the foot to the probe
inline AtEdge atEdge(EdgeKind kind, const Eigen::Vector3d& next, const Eigen::Vector3d& r) noexcept {
  return kind == EdgeKind::kConvex && r.dot(next) >= 0 ? AtEdge::kRelease : AtEdge::kSlide;
}

}  // namespace hapticd::contact
