// SPDX-License-Identifier: MIT
/// The PHANToM class of arms: a base that turns, and a parallelogram whose links are driven from the base. So the
/// angles of both links are absolute and not relative to each other: q2 is measured from the horizontal, q3 from the
/// downward vertical.
#pragma once
#include <vector>

#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

/// Published numbers of the Premium 1.5 (Cavusoglu, Feygin & Tendick 2002): lengths in m, masses in kg.
struct PhantomGeometry {
  double l1 = 0.215;    ///< upper arm
  double l2 = 0.170;    ///< forearm
  double l3 = 0.0325;   ///< short side of the parallelogram
  double l5 = -0.0368;  ///< shoulder to centre of mass of mbe, along the upper arm
  double l6 = 0.0527;   ///< shoulder to centre of mass of mdf, against the forearm
  double ma = 0.0202, mc = 0.0249, mbe = 0.2359, mdf = 0.1906;  ///< as in PhantomInertia: a, c, be, df
  Eigen::Vector3d origin{0, 0, 0};                              ///< [m] tip of the neutral pose, device frame
};

/// [main] Returns the geometry with the numbers of a device file. An empty list keeps the published numbers. Throws
/// std::invalid_argument with a message for the user.
/// @param lengths l1 l2 l3 l5 l6 [m]  @param masses ma mc mbe mdf [kg]
PhantomGeometry phantomGeometry(const std::vector<double>& lengths, const std::vector<double>& masses,
                                const Eigen::Vector3d& origin);

/// Sines and cosines of the joint angles. Several functions below need them for the same q, so they are computed once.
struct PhantomAngles {
  double s1, c1, s2, c2, s3, c3;
  explicit PhantomAngles(const Eigen::Vector3d& q) noexcept;
};

/// An arm with three joints. With c1 = cos q1 and so on, the tip is r = l1 c2 + l2 s3 away from the vertical axis and
/// h = l1 s2 - l2 c3 above the shoulder, turned by q1 about the vertical axis. The device frame follows from the
/// published base frame (x out toward the user, y, z up):
///   z = x_published, x = y_published, y = z_published.
/// As in the publication, the origin lies at the tip of the neutral pose q = 0 (upper arm level, forearm hanging).
/// There the tip is l1 out from the shoulder and l2 below it.
///
/// The thimble or stylus turns freely in a gimbal that is not measured. So the orientation is the identity, and the
/// angular rows of J are zero, because no motor can make a torque at the tip.
class Phantom : public Arm {
 public:
  explicit Phantom(const PhantomGeometry& geometry = {});

  int jointCount() const noexcept override { return 3; }
  bool forward(const JointVector& q, Pose& tip) const noexcept override;
  bool jacobian(const JointVector& q, Jacobian& J) const noexcept override;
  bool gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept override;
  bool inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept override;
  JointVector neutral() const noexcept override { return JointVector::Zero(3); }
  bool allowed(const JointVector& q) const noexcept override;
  std::span<const int32_t> parents() const noexcept override;  ///< upper arm, forearm
  Eigen::Vector3d base() const noexcept override;              ///< the shoulder
  bool links(const JointVector& q, std::span<Pose> ends) const noexcept override;

  const PhantomGeometry& geometry() const noexcept { return geometry_; }

  Eigen::Vector3d position(const Eigen::Vector3d& q) const noexcept;          ///< [any] tip [m]
  Eigen::Matrix3d positionJacobian(const Eigen::Vector3d& q) const noexcept;  ///< [any] d position / d q
  /// [any] see gravity()
  Eigen::Vector3d weight(const Eigen::Vector3d& q, const Eigen::Vector3d& gravity) const noexcept;
  Eigen::Vector3d position(const PhantomAngles& at) const noexcept;
  Eigen::Matrix3d positionJacobian(const PhantomAngles& at) const noexcept;
  Eigen::Vector3d weight(const PhantomAngles& at, const Eigen::Vector3d& gravity) const noexcept;

  static double largestOpening() noexcept;  ///< [rad] limit of q3 - q2, at which the links touch
  static double largestClosing() noexcept;  ///< [rad] limit of q2 - q3

 private:
  PhantomGeometry geometry_;
  double moment2_, moment3_;  ///< [kg m] first moments of mass along the upper arm and the forearm
};

}  // namespace hapticd::kinematics
