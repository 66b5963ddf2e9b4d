// SPDX-License-Identifier: MIT
/// Serial chains described by a Denavit-Hartenberg table: any arm of revolute and sliding joints, one after the other.
#pragma once
#include <array>
#include <vector>

#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

/// One joint and the link that it carries, in the standard (distal) Denavit-Hartenberg convention: Rot_z(theta)
/// Trans_z(d) Trans_x(a) Rot_x(alpha). The axis of the joint is z of the frame before it.
struct ChainLink {
  double a = 0, alpha = 0, d = 0;  ///< [m], [rad], [m]
  double theta = 0;                ///< [rad] added to the position of a revolute joint; fixed angle of a sliding joint
  bool sliding = false;
  double min = -M_PI, max = M_PI;                     ///< [rad] or [m]
  double mass = 0;                                    ///< [kg]
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m] centre of mass, in the frame after the joint
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< [kg m^2] about the centre, axes of the frame after the joint
};

struct ChainGeometry {
  std::vector<ChainLink> links;
  Pose base;  ///< frame 0 in the device frame
  Pose tool;  ///< pose of the tip in the last link's frame
};

/// The frames of all joints for one q, in the device frame.
struct ChainFrames {
  std::array<Eigen::Matrix3d, kMaxJoints + 1> R;  ///< orientation of frame i; frame 0 is the base
  std::array<Eigen::Vector3d, kMaxJoints + 1> o;  ///< origin of that frame; joint i turns about z of frame i
};

class Chain : public Arm {
 public:
  /// Throws std::invalid_argument with a message for the user.
  explicit Chain(const ChainGeometry& geometry);

  int jointCount() const noexcept override { return count_; }
  bool forward(const JointVector& q, Pose& tip) const noexcept override;
  bool jacobian(const JointVector& q, Jacobian& J) const noexcept override;
  bool gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept override;
  /// Considers only the position of the tip. Redundant joints stay near their start, within their limits.
  bool inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept override;
  JointVector neutral() const noexcept override;
  std::span<const int32_t> parents() const noexcept override;  ///< one link per joint frame, and one for the tool
  Eigen::Vector3d base() const noexcept override { return base_; }
  bool links(const JointVector& q, std::span<Pose> ends) const noexcept override;

  const std::array<ChainLink, kMaxJoints>& links() const noexcept { return links_; }

  /// [any] All frames of the chain.
  void frames(const JointVector& q, ChainFrames& at) const noexcept;

  /// [any] Returns the Jacobian of a point that only the first `moving` joints move, such as a wrist (Thompson et al.
  /// 1999, Eq. 8). The column of a revolute joint has z x (point - o) in its upper three rows and z in its lower three
  /// rows. The column of a sliding joint has z in its upper rows. The columns of the joints that do not move the point
  /// are zero.
  Jacobian jacobianAt(const ChainFrames& at, const Eigen::Vector3d& point, int moving) const noexcept;

 private:
  bool reach(const Eigen::Vector3d& position, JointVector& q) const noexcept;
  JointVector stepTowards(const Jacobian& J, const Eigen::Vector3d& error, double lambda,
                          const JointVector& q) const noexcept;
  Eigen::Vector3d tipOf(const ChainFrames& at) const noexcept;
  std::array<ChainLink, kMaxJoints> links_{};
  std::array<double, kMaxJoints> cos_alpha_{}, sin_alpha_{};  ///< exact if alpha is a multiple of a right angle
  Eigen::Matrix3d R_base_, R_tool_;
  Eigen::Vector3d base_, tool_;
  int count_ = 0;
};

}  // namespace hapticd::kinematics
