// SPDX-License-Identifier: MIT
/// For traced shapes that move: the frame of a model, and the probes relative to the frame to which the model has
/// moved.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "hapticd/shape.h"

namespace hapticd {

/// A model frame in the world with its velocities: hsp_pose as Eigen types.
struct MovingFrame {
  Eigen::Vector3d position{0, 0, 0};
  Eigen::Quaterniond orientation{1, 0, 0, 0};
  Eigen::Vector3d linear{0, 0, 0}, angular{0, 0, 0};

  /// [rt] Returns an hsp_pose as a MovingFrame.
  static MovingFrame of(const hsp_pose& pose) noexcept HSP_RT {
    const double* q = pose.orientation;
    return {Eigen::Vector3d(pose.position), Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized(),
            Eigen::Vector3d(pose.linear), Eigen::Vector3d(pose.angular)};
  }
  /// [rt] Writes this frame to an hsp_pose.
  void write(hsp_pose& pose) const noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) {
      pose.position[i] = position[i];
      pose.linear[i] = linear[i];
      pose.angular[i] = angular[i];
    }
    pose.orientation[0] = orientation.w();
    pose.orientation[1] = orientation.x();
    pose.orientation[2] = orientation.y();
    pose.orientation[3] = orientation.z();
  }
};

/// The probes of a step, relative to the pose to which the model has moved in this step.
class MovedProbes {
 public:
  explicit MovedProbes(uint32_t most) : probes_(most) {}  ///< [main]

  /// [rt] Returns a copy of the step `given` with its probes converted from the frame `before` to the frame `now`.
  hsp_step step(const hsp_step& given, const MovingFrame& before, const MovingFrame& now) noexcept HSP_RT {
    const Eigen::Quaterniond turn = now.orientation.conjugate() * before.orientation;
    hsp_step moved = given;
    moved.count = given.count < probes_.size() ? given.count : static_cast<uint32_t>(probes_.size());
    for (uint32_t i = 0; i < moved.count; ++i) {
      hsp_probe& probe = probes_[i];
      probe = *HSP_AT(const hsp_probe, given.in, given.in_stride, i);
      const Eigen::Vector3d from_origin = before.orientation * Eigen::Vector3d(probe.position);  // in the world frame
      const Eigen::Vector3d from_now = from_origin + (before.position - now.position);
      const Eigen::Vector3d drift =
          before.linear + before.angular.cross(from_origin) - now.linear - now.angular.cross(from_now);
      Eigen::Map<Eigen::Vector3d>(probe.position) = now.orientation.conjugate() * from_now;
      Eigen::Map<Eigen::Vector3d>(probe.velocity) =
          turn * Eigen::Vector3d(probe.velocity) + now.orientation.conjugate() * drift;
      const double* q = probe.orientation;
      const Eigen::Quaterniond seen = turn * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
      const double back[4] = {seen.w(), seen.x(), seen.y(), seen.z()};
      for (int k = 0; k < 4; ++k) probe.orientation[k] = back[k];
    }
    moved.in = probes_.data();
    moved.in_stride = sizeof(hsp_probe);
    return moved;
  }

 private:
  std::vector<hsp_probe> probes_;
};

}  // namespace hapticd
