// SPDX-License-Identifier: MIT
/// The nearest point to a probe that some planes leave free.
#pragma once
#include <Eigen/Core>
#include <array>

#include "kernels/contact/foot.hpp"

namespace hapticd::contact {

/// The points x with normal . x >= offset.
struct HalfSpace {
  Eigen::Vector3d normal{0, 0, 1};  ///< unit vector into the half-space
  double offset = 0;                ///< [m] distance of its plane from the origin, along the normal
  Foot foot{};                      ///< for a ball: its centre must stay away from this foot
  bool old = false;                 ///< for a ball: the foot is of an earlier tick

  double height(const Eigen::Vector3d& x) const noexcept { return normal.dot(x) - offset; }  ///< [m] > 0 inside
};

/// The common part of up to four half-spaces.
class HalfSpaces {
 public:
  void clear() noexcept { count_ = 0; }            ///< [rt]
  void add(const HalfSpace& half_space) noexcept;  ///< [rt] drops the oldest if there are four already
  void age() noexcept;                             ///< [rt] makes all old
  /// [rt] Drops the old ones whose feet are farther than `touching` [m] from a ball about `center`: there the face may
  /// have ended. Returns whether there was one.
  bool dropOld(const Eigen::Vector3d& center, double radius, double touching) noexcept;
  /// [rt] Turns each plane about its foot, so that it faces a ball of this radius about `center`, which touches no
  /// foot. Drops a single one: on a convex surface the next takes its place.
  void turnTo(const Eigen::Vector3d& center, double radius) noexcept;
  /// [rt] Returns the point of the common part that is nearest to p, and keeps only the half-spaces whose planes hold
  /// it back. If the half-spaces have no common point, only the newest counts. The nearest point is the one that is
  /// held by pushes alone: p plus positive multiples of the normals (Karush, Kuhn and Tucker; Nocedal and Wright,
  /// Numerical Optimization, 2nd ed., 16.1). In space three planes at most can hold it.
  Eigen::Vector3d nearestTo(const Eigen::Vector3d& p) noexcept;
  const HalfSpace* begin() const noexcept { return planes_.data(); }         ///< [rt]
  const HalfSpace* end() const noexcept { return planes_.data() + count_; }  ///< [rt]

 private:
  static constexpr int kMost = 4;
  struct Subset {
    std::array<int, 3> planes{};
    int size = 0;
  };
  bool solve(const Subset& held, const Eigen::Vector3d& p, Eigen::Vector3d& x) const noexcept;
  bool holds(const Eigen::Vector3d& x) const noexcept;
  void keep(const Subset& held) noexcept;

  std::array<HalfSpace, kMost> planes_{};  ///< newest first: of two that hold equally, the newer one is kept
  int count_ = 0;
};

}  // namespace hapticd::contact
