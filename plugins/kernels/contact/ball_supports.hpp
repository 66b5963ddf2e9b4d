// SPDX-License-Identifier: MIT
/// The places of a model on which a ball rests, in the model frame.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "kernels/contact/half_spaces.hpp"

namespace hapticd::contact {

/// A place of the surface: what a ball keeps of a foot.
struct Support {
  Eigen::Vector3d point{0, 0, 0};  ///< [m]
  double u = 0, v = 0;
  double residual = 0;  ///< [m]
  int surface = -1;
  bool on_edge = false;
  bool old = false;  ///< it is of an earlier tick
};

/// [rt] Returns the half-space that a point of the surface leaves free for the centre of a ball.
/// @param normal unit vector from the point to the ball
inline HalfSpace beyond(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double radius) noexcept {
  return {normal, normal.dot(point) + radius};
}

/// Up to four supports of a ball, and the half-space that each leaves free for its centre.
class BallSupports {
 public:
  void clear() noexcept { count_ = 0; }  ///< [rt]
  /// [rt] Drops the oldest if there are four already.
  void add(const HalfSpace& free, const Support& support) noexcept;
  void age() noexcept;  ///< [rt] makes all old
  /// [rt] Drops the old ones that are farther than `touching` [m] from a ball about `center`: there the face may have
  /// ended. Returns whether there was one.
  bool dropOld(const Eigen::Vector3d& center, double radius, double touching) noexcept;
  /// [rt] Turns each plane about its point, so that it faces a ball of this radius about `center`, which touches no
  /// point. Drops a single one: on a convex surface the next takes its place.
  void turnTo(const Eigen::Vector3d& center, double radius) noexcept;
  /// [rt] Returns the place nearest to p [m] that all leave free, and keeps only those that hold the ball back from p.
  /// If they contradict each other, only the newest counts.
  Eigen::Vector3d nearestTo(const Eigen::Vector3d& p) noexcept;

  std::size_t size() const noexcept { return count_; }                                     ///< [rt]
  const Support& operator[](std::size_t i) const noexcept { return supports_[i]; }         ///< [rt]
  const Eigen::Vector3d& normal(std::size_t i) const noexcept { return free_[i].normal; }  ///< [rt] to the ball

 private:
  void move(std::size_t from, std::size_t to) noexcept;

  // newest first: of two that hold equally, the newer one is kept
  std::array<HalfSpace, kMostHalfSpaces> free_{};
  std::array<Support, kMostHalfSpaces> supports_{};
  std::size_t count_ = 0;
};

}  // namespace hapticd::contact
