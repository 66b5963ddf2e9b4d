// SPDX-License-Identifier: MIT
/// Judges the lists that describe the mechanism of an arm, without making the arm. So it also works for files with
/// other mistakes.
#pragma once
#include <optional>
#include <string>

#include "document/node.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a table of Denavit-Hartenberg parameters whose columns are in another order, of a joint that cannot
/// move, and of keys that an arm of this kind does not have. @param root content of a device file
void warnOfTable(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Warns of masses and torques that are impossible for an arm that a hand moves, unless the key already has a
/// warning.
void warnOfWeights(const document::Node& root, const std::string& file, document::Problems& warnings);

/// [main] Returns a warning about the first joint that cannot move, because its stops are too close together.
std::optional<document::Problem> stuckJoint(const document::Node& root, const std::string& file);

}  // namespace hapticd::diagnostics
