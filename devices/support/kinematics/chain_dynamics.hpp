// SPDX-License-Identifier: MIT
/// Rigid-body dynamics of a serial chain: mass matrix by composite bodies, and the bias torques by a recursive
/// Newton-Euler pass (Featherstone 2008, chapters 5 and 6).
#pragma once
#include "kinematics/chain.hpp"

namespace hapticd::kinematics {

using MassMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, kMaxJoints>;

/// [any] Computes M(q) and c(q, qd) of the equation of motion M qdd + c = tau - gravity. @param at the frames for q
void chainDynamics(const Chain& chain, const ChainFrames& at, const JointVector& qd, MassMatrix& M,
                   JointVector& c) noexcept;

}  // namespace hapticd::kinematics
