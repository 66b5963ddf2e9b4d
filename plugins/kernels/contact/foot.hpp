// SPDX-License-Identifier: MIT
/// The foot point of a probe on a model, in the model frame: the result of every kernel that finds nearest points.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace hapticd::contact {

/// How reliable the foot of a tick is.
enum class FootStatus : std::uint8_t {
  kNearest,  ///< the nearest point of all surfaces that are traced, to the tolerance
  kHeld,     ///< the foot of a held contact, followed since the probe entered; another surface may be nearer
  /// the limit of evaluations was reached: the foot has an error (see residual), or another foot may be nearer
  kDegraded,
  kIdle,    ///< no surface is traced: the foot has no meaning
  kInvalid  ///< the probe's position is not finite; the state of the tracing was not changed
};

/// Which side of a surface has the solid behind it.
enum class Sides : std::uint8_t {
  kFront,  ///< the solid is behind the outward normal
  kBack,   ///< the solid is in front of the surface, on the side of its outward normal
  kBoth    ///< a shell: pushes the probe back to the side from which it came
};

/// The foot point of a tick: the nearest point, or the point of a held contact. If the probe is inside several parts at
/// once, it is the point at which the shortest way out of all of them ends.
struct Foot {
  Eigen::Vector3d point{0, 0, 0};   ///< [m] position of the foot
  Eigen::Vector3d normal{0, 0, 1};  ///< unit normal, pointing away from the solid
  double depth = 0;                 ///< [m] penetration depth: > 0 inside; outside, minus the distance
  double distance = 0;              ///< [m] distance from the probe to the point
  /// [m] height of the probe over the tangent plane, times -1: > 0 behind the surface, < 0 in front of it
  double behind = 0;
  /// [m] sideways distance of the probe from the free edge on which the foot lies; 0 if the foot is not on a free edge
  double aside = 0;
  double u = 0, v = 0;  ///< parameters of the foot on its surface
  double residual = 0;  ///< [m] estimated error of the point
  int surface = -1;     ///< index of the surface in the model file
  int evaluations = 0;  ///< number of evaluations of surfaces in this tick
  FootStatus status = FootStatus::kIdle;
  bool on_edge = false;  ///< the foot is on an edge or a corner
  /// the contact began in this tick, or its foot crossed an edge to another face; the foot may have jumped
  bool begins = false;
};

/// [any] True if a foot was found at all.
inline bool found(const Foot& foot) noexcept {
  return foot.status < FootStatus::kIdle;
}

/// [any] Converts a foot with the outward normal into the foot that is felt from one side of the surface.
/// @param side +1 for the front, -1 for the back
inline Foot seenFrom(Foot foot, double side) noexcept {
  foot.normal *= side;
  foot.behind *= side;
  const double depth = foot.behind - foot.aside;
  foot.depth = depth > 0 ? depth : -foot.distance;
  return foot;
}

/// [rt] Returns how near [m] the surface about a foot may be. A foot of method dpt lags behind and is farther.
inline double atLeast(const Foot& foot) noexcept {
  const double height = foot.on_edge ? foot.distance : std::abs(foot.behind);
  return std::max(std::min(foot.distance - foot.residual, height), 0.0);
}

}  // namespace hapticd::contact
