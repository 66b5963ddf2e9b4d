// SPDX-License-Identifier: MIT
/// Poses that do not drift: unit quaternions, turned exactly and renormalised, never multiplied matrices.
#pragma once
#include <Eigen/Geometry>

namespace hapticd::dynamics {

/// [rt] The rotation by `turn` [rad], which is axis times angle. Exact for every angle, also for small ones.
Eigen::Quaterniond rotationBy(const Eigen::Vector3d& turn) noexcept;

/// A unit quaternion near 1 that keeps the digits of its difference from 1: (1 + less, vector).
struct SmallTurn {
  Eigen::Vector3d vector{0, 0, 0};
  double less = 0;
};

/// An orientation turned step by step. The rounding of every product is carried over to the next (compensated
/// multiplication) and turns up to 1 rad are taken to more digits than a double has: 1e8 steps of up to 0.1 rad about
/// one axis end within 1e-11 rad of the truth (test Rotation.AHundredMillionTicksDriftByRoundingOnly).
class Rotation {
 public:
  Rotation() = default;
  explicit Rotation(const Eigen::Quaterniond& q) noexcept { set(q); }  ///< [any] normalised here
  void set(const Eigen::Quaterniond& q) noexcept;                      ///< [rt]

  /// [rt] Turns by `turn` [rad] about axes of the world.
  void turnWorld(const Eigen::Vector3d& turn) noexcept;
  /// [rt] Turns by `turn` [rad] about the body's own axes.
  void turnBody(const Eigen::Vector3d& turn) noexcept;
  void turnBody(const SmallTurn& turn) noexcept;  ///< [rt] about its own axes

  const Eigen::Quaterniond& quaternion() const noexcept { return q_; }
  Eigen::Matrix3d matrix() const noexcept { return q_.toRotationMatrix(); }

 private:
  void apply(const Eigen::Vector3d& v, const Eigen::Vector3d& rest, double cosine_less_one, bool world) noexcept;
  Eigen::Quaterniond q_{1, 0, 0, 0};
  Eigen::Vector4d carry_{0, 0, 0, 0};  // x, y, z, w: what rounding took from q_
};

}  // namespace hapticd::dynamics
