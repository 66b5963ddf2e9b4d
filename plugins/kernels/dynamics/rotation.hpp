/// Poses that do not drift: unit quaternions, turned exactly and renormalised, never multiplied matrices.
#pragma once
#include <Eigen/Geometry>

namespace hapticd::dynamics {

/// [rt] The rotation by `turn` [rad]: axis times angle. Exact for every angle, small ones too.
Eigen::Quaterniond rotationBy(const Eigen::Vector3d& turn) noexcept;

/// An orientation turned step by step. The rounding of every product is carried over to the next (compensated
/// multiplication), so that the error after 1e8 steps is that of a few.
class Rotation {
 public:
  Rotation() = default;
  explicit Rotation(const Eigen::Quaterniond& q) noexcept { set(q); }  ///< [any] normalised here
  void set(const Eigen::Quaterniond& q) noexcept;                      ///< [rt]

  /// [rt] Turns by `turn` [rad] about axes of the world.
  void turnWorld(const Eigen::Vector3d& turn) noexcept;
  /// [rt] Turns by `turn` [rad] about the body's own axes.
  void turnBody(const Eigen::Vector3d& turn) noexcept;

  const Eigen::Quaterniond& quaternion() const noexcept { return q_; }
  Eigen::Matrix3d matrix() const noexcept { return q_.toRotationMatrix(); }

 private:
  void apply(const Eigen::Vector3d& turn, bool world) noexcept;
  Eigen::Quaterniond q_{1, 0, 0, 0};
  Eigen::Vector4d carry_{0, 0, 0, 0};  // x, y, z, w: what rounding took from q_
};

}  // namespace hapticd::dynamics
