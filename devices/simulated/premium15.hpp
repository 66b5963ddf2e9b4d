/// Kinematics and rigid-body dynamics of the PHANToM Premium 1.5, a three-joint arm whose second and third links are
/// driven in parallel (Cavusoglu, Feygin, Tendick 2002, "A critical study of the mechanical and electrical properties
/// of the PHANToM haptic interface").
///
/// Joints q1 (turn of the base), q2 (upper arm above the horizontal), q3 (forearm from the downward vertical) are
/// absolute angles. Device frame: x right, y up, z toward the user; its origin is the tip at q = 0.
#pragma once
#include <Eigen/Core>

namespace hapticd::simulated {

struct PhantomLinks {
  double upper_arm = 0.215;  ///< l1 [m]
  double forearm = 0.170;    ///< l2 [m]
};

class Phantom {
 public:
  using Joints = Eigen::Vector3d;
  explicit Phantom(const PhantomLinks& links = {}) : links_(links) {}

  /// [any] Tip [m].
  Eigen::Vector3d forward(const Joints& q) const noexcept;
  /// [any] d tip / d q [m/rad].
  Eigen::Matrix3d jacobian(const Joints& q) const noexcept;
  /// [any] Acceleration of the tip at joint rates qd without joint acceleration: (dJ/dt) qd [m/s^2].
  Eigen::Vector3d velocityProduct(const Joints& q, const Joints& qd) const noexcept;
  /// [any] Joints that reach `tip`, elbow up as the arm is built. False: out of reach.
  bool inverse(const Eigen::Vector3d& tip, Joints& q) const noexcept;

 private:
  PhantomLinks links_;
};

/// Masses and inertias of the Premium 1.5, identified by Cavusoglu et al.; a: forearm, be, df: the driven pairs of
/// links with their counterweights, c: the parallel link.
struct PhantomInertia {
  double l1 = 0.215, l2 = 0.170, l3 = 0.0325, l5 = -0.0368, l6 = 0.0527;  ///< [m]
  double m_a = 0.0202, m_c = 0.0249, m_be = 0.2359, m_df = 0.1906;        ///< [kg]
  double a_xx = 0.4864e-4, a_yy = 0.001843e-4, a_zz = 0.4864e-4;          ///< [kg m^2]
  double c_xx = 0.959e-4, c_yy = 0.959e-4, c_zz = 0.0051e-4;
  double be_xx = 11.09e-4, be_yy = 10.06e-4, be_zz = 0.591e-4;
  double df_xx = 7.11e-4, df_yy = 0.629e-4, df_zz = 6.246e-4;
  double base_yy = 11.87e-4;

  /// [any] Mass matrix [kg m^2].
  Eigen::Matrix3d mass(const Eigen::Vector3d& q) const noexcept;
  /// [any] Coriolis and centrifugal torques [N m]: C(q, qd) qd.
  Eigen::Vector3d coriolis(const Eigen::Vector3d& q, const Eigen::Vector3d& qd) const noexcept;
  /// [any] Torques [N m] that hold the arm against a gravity of `g` [m/s^2] downwards.
  Eigen::Vector3d gravity(const Eigen::Vector3d& q, double g) const noexcept;
};

}  // namespace hapticd::simulated
