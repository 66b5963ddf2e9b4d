// SPDX-License-Identifier: MIT
/// Statics: the wrench at the tip and the torques of the joints (Thompson et al. 1999, Eq. 7-9), and how near an arm is
/// to a singular pose.
#pragma once
#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

/// [any] Returns tau = J^T W (Eq. 9), the torques with which the motors make the tip push with the wrench W.
JointVector jointTorques(const Jacobian& J, const Wrench& W) noexcept;

/// Singular values of a Jacobian, sorted from large to small. A length makes angles comparable to distances.
struct Conditioning {
  Eigen::Matrix<double, 6, 1> values = Eigen::Matrix<double, 6, 1>::Zero();
  int rank = 0;                  ///< number of values that are not (nearly) zero
  double smallest = 0;           ///< smallest of the min(6, n) values
  double inverse_condition = 0;  ///< smallest over largest: 1 is isotropic, 0 is singular
  double manipulability = 0;     ///< product of the min(6, n) values (Yoshikawa)
};

struct PseudoInverseOptions {
  double length = 0.1;           ///< [m] one radian of tip rotation counts as this much travel
  double rank_tolerance = 1e-9;  ///< singular values below this fraction of the largest count as zero
  double damping = 0;  ///< values below this fraction of the largest are damped (Nakamura & Hanafusa 1986); 0: none
};

struct WrenchEstimate {
  Wrench W = Wrench::Zero();
  int rank = 0;         ///< 6 if W is unique; if less, W is the smallest wrench that fits the torques
  double residual = 0;  ///< [N m] |J^T W - tau|, the part of the torques that no wrench at the tip can cause
};

/// [any] Returns the wrench at the tip that fits measured joint torques: W = pinv(J^T) tau, with the rank of J; damped
/// near singular poses.
WrenchEstimate wrenchFromTorques(const Jacobian& J, const JointVector& tau,
                                 const PseudoInverseOptions& how = {}) noexcept;

/// [any] Returns the singular values of J with angles scaled by `length` [m]. With `position_only` it uses only the
/// rows of the linear velocity.
Conditioning conditioning(const Jacobian& J, double length = 0.1, bool position_only = false) noexcept;

}  // namespace hapticd::kinematics
