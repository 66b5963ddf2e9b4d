// SPDX-License-Identifier: MIT
/// Rigid frames and the transforms of one tick. Shapes never move in memory: the probe is transformed by the inverse of
/// each model's pose, and only foot points and normals are transformed back (Thompson et al. 1999, section 5.2.2: n +
/// 2m transforms).
#pragma once
#include <Eigen/Geometry>

#include "hapticd/shape.h"

namespace hapticd::servo {

using Eigen::Vector3d;

/// Writes a quaternion in the order of the ABI: w, x, y, z.
inline void storeQuaternion(const Eigen::Quaterniond& q, double* wxyz) noexcept {
  wxyz[0] = q.w(), wxyz[1] = q.x(), wxyz[2] = q.y(), wxyz[3] = q.z();
}
/// Reads a quaternion in the order of the ABI.
inline Eigen::Quaterniond quaternionOf(const double* wxyz) noexcept {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

/// Pose of a model in the world, with a rotation matrix, for use within a tick. Elsewhere poses have quaternions.
struct Frame {
  Eigen::Matrix3d R_world_model = Eigen::Matrix3d::Identity();
  Vector3d origin_world = Vector3d::Zero();
  bool identity = true;  ///< true if it is the world frame: transforms can be skipped

  static Frame of(const hsp_pose& pose) noexcept {
    Frame frame;
    const Eigen::Quaterniond q = quaternionOf(pose.orientation);
    frame.R_world_model = q.toRotationMatrix();
    frame.origin_world = Vector3d(pose.position);
    frame.identity = frame.origin_world.isZero(0) && q.vec().isZero(0);
    return frame;
  }
  /// Transforms a position from the world to the model frame.
  Vector3d pointToModel(const Vector3d& p_world) const noexcept {
    return identity ? p_world : Vector3d(R_world_model.transpose() * (p_world - origin_world));
  }
  Vector3d pointToWorld(const Vector3d& p_model) const noexcept {
    return identity ? p_model : Vector3d(R_world_model * p_model + origin_world);
  }
  Vector3d vectorToModel(const Vector3d& v_world) const noexcept {
    return identity ? v_world : Vector3d(R_world_model.transpose() * v_world);
  }
  Vector3d vectorToWorld(const Vector3d& v_model) const noexcept {
    return identity ? v_model : Vector3d(R_world_model * v_model);
  }
};

}  // namespace hapticd::servo
