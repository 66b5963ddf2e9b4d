// SPDX-License-Identifier: MIT
/// Statics: wrenches at the tip and torques in the joints (Thompson et al. 1999, Eq. 7-9), and how near an arm is to a
/// singular pose.
#pragma once
#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

/// [any] tau = J^T W (Eq. 9): the torques that the motors must produce so that the tip pushes with W.
JointVector jointTorques(const Jacobian& J, const Wrench& W) noexcept;

/// Singular values of a Jacobian, sorted from large to small. Angles are made comparable to distances by a length.
struct Conditioning {
  Eigen::Matrix<double, 6, 1> values = Eigen::Matrix<double, 6, 1>::Zero();
  int rank = 0;
  double smallest = 0;           ///< how many of the min(6, n) are not zero
  double inverse_condition = 0;  ///< smallest over largest: 1 is isotropic, 0 is singular
  double manipulability = 0;     ///< product of the min(6, n) values (Yoshikawa)
};

struct PseudoInverseOptions {
  double length = 0.1;           ///< [m] one radian of tip rotation counts as this much travel
  double rank_tolerance = 1e-9;  ///< singular values below this fraction of the largest count as zero
  double damping = 0;  ///< fraction of the largest: values below it are damped (Nakamura & Hanafusa 1986); 0: exact
};

struct WrenchEstimate {
  Wrench W = Wrench::Zero();
  int rank = 0;         ///< 6: W is unique. Less: W is the smallest wrench that explains the torques
  double residual = 0;  ///< [N m] |J^T W - tau|: the torque that no wrench at the tip explains
};

/// [any] The wrench that measured joint torques amount to: W = pinv(J^T) tau, by rank; damped near singular poses.
WrenchEstimate wrenchFromTorques(const Jacobian& J, const JointVector& tau,
                                 const PseudoInverseOptions& how = {}) noexcept;

/// [any] Singular values of J with angles scaled by `length` [m]; position rows only if `position_only`.
Conditioning conditioning(const Jacobian& J, double length = 0.1, bool position_only = false) noexcept;

}  // namespace hapticd::kinematics
