// SPDX-License-Identifier: MIT
/// Finds a place that an arm reaches, near to one that it cannot reach.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "kinematics/arm.hpp"

namespace hapticd::simulated {

/// [main] Returns a place [m] in whole mm (device frame) that the arm reaches, near to `wanted`; nothing if the search
/// finds none.
std::optional<Eigen::Vector3d> nearestPlace(const kinematics::Arm& arm, const Eigen::Vector3d& wanted);

}  // namespace hapticd::simulated
