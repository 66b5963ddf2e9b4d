// SPDX-License-Identifier: MIT
/// What every arm can say of itself without its motors: where its tip is, how joint motion moves it, and which joint
/// torques carry its own weight. Vectors are in the DEVICE frame: x right, y up, z toward the user.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>

namespace hapticd::kinematics {

inline constexpr int kMaxJoints = 16;

/// Joint values [rad] ([m] of a sliding joint) or torques [N m] ([N]); bounded storage, never allocates.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;
/// 6 x n: rows 0-2 velocity of the tip, rows 3-5 angular velocity, a column a joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;
/// Force [N], then torque [N m], at the tip.
using Wrench = Eigen::Matrix<double, 6, 1>;

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Where the tip can be, as a box and as joint limits.
struct JointLimits {
  JointVector min, max;
};

/// Kinematics of one arm. Functions are const, allocation-free and usable from every thread.
class Arm {
 public:
  virtual ~Arm() = default;

  virtual int jointCount() const noexcept = 0;                    ///< [any]
  const JointLimits& limits() const noexcept { return limits_; }  ///< [any]

  /// [any] Pose of the tip. False if the mechanism cannot have these joints (a delta that does not close).
  virtual bool forward(const JointVector& q, Pose& tip) const noexcept = 0;

  /// [any] J(q) of the point and orientation that forward() gives. False in the same cases, and where J does not exist.
  virtual bool jacobian(const JointVector& q, Jacobian& J) const noexcept = 0;

  /// [any] Torques that hold the arm still under gravity [m/s^2].
  virtual bool gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept = 0;

  /// [any] Joints that bring the tip to a position [m], starting from q and, where there are several, nearest to it.
  /// False: out of reach or of the joint limits; q is unchanged.
  virtual bool inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept = 0;

  /// [any] The pose in the middle of the workspace.
  virtual JointVector neutral() const noexcept = 0;

  /// How the links are connected: for each link the number of the one it begins at, -1 for the base. The last link ends
  /// at the tip. An empty list means that the arm cannot be drawn.
  virtual std::span<const int32_t> parents() const noexcept { return {}; }
  virtual Eigen::Vector3d base() const noexcept { return Eigen::Vector3d::Zero(); }  ///< [m] where the first begins
  /// [any] The far end of each link and the orientation of its body. False as forward() is.
  virtual bool links(const JointVector& /*q*/, std::span<Pose> /*ends*/) const noexcept { return false; }

  /// [main] The stops of one arm within its mechanism's. Throws std::invalid_argument with a message for the user.
  void narrow(const JointLimits& limits);

  /// [any] True if q is within the limits, the coupled ones included.
  virtual bool allowed(const JointVector& q) const noexcept;

 protected:
  JointLimits limits_;
};

}  // namespace hapticd::kinematics
