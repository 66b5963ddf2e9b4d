// SPDX-License-Identifier: MIT
/// Makes the kinematics of an arm from the parameters of its device file.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "kinematics/arm.hpp"

namespace hapticd::wire_arm {

enum class Kind { kPhantom, kDelta, kChain };

struct MechanismParameters {
  int kind = 0;
  int others = 0;
  std::array<double, 3> origin{}, tool_position{};
  std::vector<double> base_orientation, lengths, masses, centers, angles, dh, limits;
};

/// [main] Returns the number of joints that the parameters describe, also if some of them are wrong; 0 if it is
/// unknown.
size_t jointsOf(const MechanismParameters& p);

/// [main] Throws std::invalid_argument with a message for the user.
std::unique_ptr<kinematics::Arm> makeMechanism(const MechanismParameters& p);

}  // namespace hapticd::wire_arm
