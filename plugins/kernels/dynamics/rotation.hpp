// SPDX-License-Identifier: MIT
/// Orientations that do not drift. They are unit quaternions that are turned exactly and renormalised. Products of
/// matrices would drift.
#pragma once
#include <Eigen/Geometry>

namespace hapticd::dynamics {

/// [rt] Returns the rotation by `turn` [rad], a rotation axis times its angle. It is exact to rounding also for small
/// angles.
Eigen::Quaterniond rotationBy(const Eigen::Vector3d& turn) noexcept;

/// A unit quaternion near 1: the scalar part is 1 + less, the vector part is `vector`. The small difference from 1
/// keeps its full precision.
struct SmallTurn {
  Eigen::Vector3d vector{0, 0, 0};
  double less = 0;
};

/// An orientation that is turned step by step. The rounding error of every product is carried over to the next one
/// (compensated multiplication), and turns up to 1 rad are computed to more digits than a double has. So after 1e8
/// steps of up to 0.1 rad about one axis the error is below 1e-11 rad (test
/// Rotation.AHundredMillionTicksDriftByRoundingOnly).
class Rotation {
 public:
  Rotation() = default;
  explicit Rotation(const Eigen::Quaterniond& q) noexcept { set(q); }  ///< [any] normalises q
  void set(const Eigen::Quaterniond& q) noexcept;                      ///< [rt] normalises q

  /// [rt] Turns by `turn` [rad] about axes of the world.
  void turnWorld(const Eigen::Vector3d& turn) noexcept;
  /// [rt] Turns by `turn` [rad] about the body's own axes.
  void turnBody(const Eigen::Vector3d& turn) noexcept;
  void turnBody(const SmallTurn& turn) noexcept;  ///< [rt] turns about the body's own axes

  const Eigen::Quaterniond& quaternion() const noexcept { return q_; }
  Eigen::Matrix3d matrix() const noexcept { return q_.toRotationMatrix(); }

 private:
  void apply(const Eigen::Vector3d& v, const Eigen::Vector3d& rest, double cosine_less_one, bool world) noexcept;
  Eigen::Quaterniond q_{1, 0, 0, 0};
  Eigen::Vector4d carry_{0, 0, 0, 0};  // x, y, z, w: rounding error of q_, still to be added
};

}  // namespace hapticd::dynamics
