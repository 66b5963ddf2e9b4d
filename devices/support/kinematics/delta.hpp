// SPDX-License-Identifier: MIT
/// Delta arms (Novint Falcon): three driven upper arms on a fixed base, three parallelograms to a platform that only
/// translates. Geometry after Stamper (1997) and Tsai.
#pragma once
#include <array>
#include <vector>

#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

/// Lengths in m, with the names of the literature. Arm frame i is turned by `phi[i]` about the axis of the device.
struct DeltaGeometry {
  double a = 0.060;                 ///< driven upper arm
  double b = 0.1025;                ///< parallelogram
  double c = 0.01443;               ///< platform: radial offset of the last hinge
  double d = 0.01125, e = 0.01125;  ///< lengths of the hinges before and after the parallelogram
  double f = -0.025;                ///< platform: tangential offset
  double r = 0.040;                 ///< base: radius of the driven axes
  double s = -0.02309;              ///< base: tangential offset
  std::array<double, 3> phi{105 * M_PI / 180, -15 * M_PI / 180, -135 * M_PI / 180};
  double theta_min = -0.6, theta_max = 1.7;                       ///< [rad] limits of the driven arms
  double arm_mass = 0.05, rod_mass = 0.04, platform_mass = 0.08;  ///< [kg] each upper arm; each rod pair; platform
  Pose base;  ///< frame of the base in the device frame; its z points to the platform
};

/// [main] Returns the geometry with the numbers of a device file. An empty list keeps the default. Throws
/// std::invalid_argument with a message for the user.
/// @param lengths a b c d e f r s [m]  @param masses arm, rod pair, platform [kg]  @param angles of the three arms
/// [rad]
DeltaGeometry deltaGeometry(const std::vector<double>& lengths, const std::vector<double>& masses,
                            const std::vector<double>& angles);

/// How the tip follows the joints.
struct DeltaMotion {
  Eigen::Vector3d tip;    ///< [m]
  Eigen::Matrix3d J;      ///< the tip's velocity for given joint velocities
  Eigen::Vector3d swing;  ///< [m/s^2] (dJ/dt) qd, the tip's acceleration when no joint accelerates
};

class Delta : public Arm {
 public:
  /// Throws std::invalid_argument with a message for the user.
  explicit Delta(const DeltaGeometry& geometry = {});

  int jointCount() const noexcept override { return 3; }
  /// Uses Newton's method from the middle of the workspace. Returns false if the three parallelograms cannot meet.
  bool forward(const JointVector& q, Pose& tip) const noexcept override;
  bool jacobian(const JointVector& q, Jacobian& J) const noexcept override;
  /// Counts half of each rod pair's mass to its upper arm, and the other half to the platform.
  bool gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept override;
  bool inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept override;
  JointVector neutral() const noexcept override { return neutral_; }
  const DeltaGeometry& geometry() const noexcept { return geometry_; }
  /// [any] Computes the motion of the tip, device frame. Returns false if forward() does.
  bool motion(const JointVector& q, const JointVector& qd, DeltaMotion& motion) const noexcept;
  std::span<const int32_t> parents() const noexcept override;  ///< upper arms, rods to the platform, the tip
  Eigen::Vector3d base() const noexcept override { return geometry_.base.position; }
  bool links(const JointVector& q, std::span<Pose> ends) const noexcept override;

 private:
  /// The closure condition g(p, theta) = 0 of one arm, with its derivatives; p is in the frame of the base.
  struct Closure {
    double value, d_theta;
    Eigen::Vector3d d_p;
    bool valid;
  };
  /// Returns d^2 g / dt^2 of one arm while neither the platform nor the joint accelerates.
  double curvature(size_t arm, const Eigen::Vector3d& p, double theta, const Eigen::Vector3d& dp,
                   double d_theta) const noexcept;
  Closure closure(size_t arm, const Eigen::Vector3d& p, double theta) const noexcept;
  bool solve(const JointVector& q, Eigen::Vector3d& p) const noexcept;
  bool localJacobian(const JointVector& q, Eigen::Vector3d& p, Eigen::Matrix3d& J, Eigen::Matrix3d& A) const noexcept;

  DeltaGeometry geometry_;
  Eigen::Matrix3d R_device_arm_;
  std::array<double, 3> cos_{}, sin_{};
  JointVector neutral_;
  Eigen::Vector3d middle_;  ///< [m] position from which the search of forward() starts
};

}  // namespace hapticd::kinematics
