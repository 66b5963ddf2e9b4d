// SPDX-License-Identifier: MIT
/// The foot of a probe on a model: what every kernel that finds nearest points answers, in the model's frame.
#pragma once
#include <Eigen/Core>
#include <cstdint>

namespace hapticd::contact {

/// How much a tick guarantees about its foot.
enum class FootStatus : std::uint8_t {
  kNearest,   ///< the nearest point of all surfaces that are followed, to the tolerance
  kHeld,      ///< followed from where the probe entered; another surface is nearer, or may be
  kDegraded,  ///< the evaluations were used up: the residual is the foot's error, or another foot is nearer
  kIdle,      ///< nothing is followed: the foot has no meaning
  kInvalid    ///< the probe's position is not finite; what is followed was kept as it was
};

/// Which side of a surface has the solid behind it.
enum class Sides : std::uint8_t {
  kFront,  ///< the solid is behind the outward normal
  kBack,   ///< the solid is before it
  kBoth    ///< a shell: pushes back to the side from which it was entered
};

/// Nearest point, or the point of a held contact. Inside several parts at once: what leads out of all of them.
struct Foot {
  Eigen::Vector3d point{0, 0, 0};   ///< [m]
  Eigen::Vector3d normal{0, 0, 1};  ///< unit, away from the solid
  double depth = 0;                 ///< [m] > 0 inside, minus the distance outside
  double distance = 0;              ///< [m] from the probe to the point
  double behind = 0;                ///< [m] of the probe behind the surface, negative in front of it
  double aside = 0;                 ///< [m] of the probe beside a free edge that has the foot
  double u = 0, v = 0;              ///< parameters of the surface
  double residual = 0;              ///< [m] estimated error of the point
  int surface = -1;                 ///< index in the model file
  int evaluations = 0;              ///< of surfaces, in this tick
  FootStatus status = FootStatus::kIdle;
  bool on_edge = false;  ///< the foot is on an edge or a corner
  bool begins = false;   ///< the contact began in this tick, or moved to another place, so the foot may have jumped
};

/// [any] True if a foot was found at all.
inline bool found(const Foot& foot) noexcept {
  return foot.status < FootStatus::kIdle;
}

/// [any] A foot of the outward normal as it is felt from one side of its surface. @param side +1: the front, -1: the
/// back
inline Foot seenFrom(Foot foot, double side) noexcept {
  foot.normal *= side;
  foot.behind *= side;
  const double depth = foot.behind - foot.aside;
  foot.depth = depth > 0 ? depth : -foot.distance;
  return foot;
}

}  // namespace hapticd::contact
