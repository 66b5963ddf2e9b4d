// SPDX-License-Identifier: MIT
/// A simulated arm with the mechanism of a real one, to try scenes before the real one is there.
#pragma once
#include <string>

#include "base/result.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] The text of a device file of module `simulated`, with the kinematics, limits and encoders of the arm that
/// `root` describes, and a hand that presses a sphere of 0.05 m about the world's origin. Fails for an arm without a
/// twin, or a file that describes none.
/// @param file its name, for the comment
Result<std::string> twinOf(const document::Node& root, const std::string& file);

/// [main] Which numbers of the twin come from elsewhere, because the arm's file lacks them; "" if none do.
std::string borrowedByTwin(const document::Node& root);

}  // namespace hapticd::diagnostics
