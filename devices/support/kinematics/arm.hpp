// SPDX-License-Identifier: MIT
/// Kinematics and statics of an arm: the pose of its tip, the velocity of the tip for given joint velocities, and the
/// joint torques that carry the arm's weight. Vectors are in the DEVICE frame: x right, y up, z toward the user.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>

namespace hapticd::kinematics {

inline constexpr int kMaxJoints = 16;

/// Joint positions [rad] ([m] for a sliding joint) or torques [N m] ([N]); bounded storage, never allocates.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;
/// 6 x n matrix with one column per joint: rows 0-2 linear velocity of the tip, rows 3-5 angular velocity.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;
/// Force [N], then torque [N m], at the tip.
using Wrench = Eigen::Matrix<double, 6, 1>;

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Smallest and greatest position of each joint [rad or m].
struct JointLimits {
  JointVector min, max;
};

/// Kinematics of one arm. Functions are const, allocation-free and usable from every thread.
class Arm {
 public:
  virtual ~Arm() = default;

  virtual int jointCount() const noexcept = 0;                    ///< [any]
  const JointLimits& limits() const noexcept { return limits_; }  ///< [any]

  /// [any] Computes the pose of the tip. Returns false if the mechanism cannot have these joint positions, for example
  /// if the arms of a delta do not meet.
  virtual bool forward(const JointVector& q, Pose& tip) const noexcept = 0;

  /// [any] Computes the Jacobian J(q) of the pose that forward() gives. Returns false if forward() does, or if J does
  /// not exist.
  virtual bool jacobian(const JointVector& q, Jacobian& J) const noexcept = 0;

  /// [any] Computes the torques that hold the arm still under gravity [m/s^2]. Returns false if forward() does.
  virtual bool gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept = 0;

  /// [any] Computes the joint positions that bring the tip to a position [m]. The search starts from the given q; of
  /// several solutions it finds the one nearest to q. Returns false, with q unchanged, if the position is out of reach
  /// or needs joints beyond their limits.
  virtual bool inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept = 0;

  /// [any] Returns the joint positions for which the tip is in the middle of the workspace.
  virtual JointVector neutral() const noexcept = 0;

  /// How the links are connected: for each link, the number of the link at whose end it begins, or -1 for the base. The
  /// last link ends at the tip. An empty list means that the arm cannot be drawn.
  virtual std::span<const int32_t> parents() const noexcept { return {}; }
  virtual Eigen::Vector3d base() const noexcept { return Eigen::Vector3d::Zero(); }  ///< [m] start of the first link
  /// [any] Computes the far end of each link and the orientation of its body. Returns false if forward() does.
  virtual bool links(const JointVector& /*q*/, std::span<Pose> /*ends*/) const noexcept { return false; }

  /// [main] Replaces the joint limits of the mechanism by those of one arm. Throws std::invalid_argument with a message
  /// for the user if a row is missing or in the wrong order; does not check that the new limits are narrower.
  void narrow(const JointLimits& limits);

  /// [any] Returns whether q is within the limits, including limits that couple several joints.
  virtual bool allowed(const JointVector& q) const noexcept;

 protected:
  JointLimits limits_;
};

}  // namespace hapticd::kinematics
