// SPDX-License-Identifier: MIT
/// Rigid-body dynamics of the PHANToM Premium 1.5 in closed form (Cavusoglu, Feygin & Tendick 2002).
#pragma once
#include "kinematics/phantom.hpp"

namespace hapticd::kinematics {

/// Published principal inertias [kg m^2] of the forearm (a), the parallel link (c), the upper arm with its motor (be),
/// the short link with its motor (df) and the base. Masses and lengths are in PhantomGeometry.
struct PhantomInertia {
  Eigen::Vector3d a{0.4864e-4, 0.001843e-4, 0.4864e-4};
  Eigen::Vector3d c{0.959e-4, 0.959e-4, 0.0051e-4};
  Eigen::Vector3d be{11.09e-4, 10.06e-4, 0.591e-4};
  Eigen::Vector3d df{7.11e-4, 0.629e-4, 6.246e-4};
  double base_yy = 11.87e-4;
  /// [kg m^2] inertias of the motors' rotors at their joints, multiplied by the squared gear ratios
  Eigen::Vector3d rotor{1.08e-6 * 13.3 * 13.3, 1.08e-6 * 11.2 * 11.2, 1.08e-6 * 11.2 * 11.2};
};

/// The equation of motion M(q) qdd + c(q, qd) = tau - gravity. M depends on q2 and q3 only through two cosines and two
/// products, so the constant factors are computed once.
class PhantomDynamics {
 public:
  PhantomDynamics(const PhantomGeometry& geometry, const PhantomInertia& inertia);

  /// [rt] Computes the mass matrix, and the Coriolis and centrifugal torques (with the Christoffel symbols of M, so
  /// that dM/dt - 2 C is skew-symmetric).
  void evaluate(const Eigen::Vector3d& q, const Eigen::Vector3d& qd, Eigen::Matrix3d& M,
                Eigen::Vector3d& c) const noexcept;
  void evaluate(const PhantomAngles& at, const Eigen::Vector3d& qd, Eigen::Matrix3d& M,
                Eigen::Vector3d& c) const noexcept;

 private:
  double base_, upper_, fore_, cross_;  ///< M11 = base + upper cos 2q2 + fore cos 2q3 + 2 cross c2 s3
  double m22_, m33_;
  Eigen::Vector3d rotor_;
};

}  // namespace hapticd::kinematics
