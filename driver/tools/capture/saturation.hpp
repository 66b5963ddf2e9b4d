// SPDX-License-Identifier: MIT
/// Numbers that do not fit into the field that carries them.
#pragma once
#include <string>
#include <vector>

#include "codec/wire.hpp"

namespace hapticd::capture {

/// [main] Of one line of numbers, as encodeRow() takes it, those that are sent as another number, in words: "torque1:
/// 0.7 is beyond what its field can carry, -0.5 to 0.5; sent as 0.5".
/// @param to_arm an order; otherwise as the arm would send it
std::vector<std::string> saturated(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns,
                                   const double* values);

}  // namespace hapticd::capture
