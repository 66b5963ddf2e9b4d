// SPDX-License-Identifier: MIT
/// Makes a twin: a simulated arm with the mechanism of a real one, to try scenes before the real arm is there.
#pragma once
#include <string>

#include "base/result.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the text of a device file of module `simulated`, with the kinematics, limits and encoders of the arm
/// that `root` describes, and a hand that presses a sphere of 0.05 m about the world's origin. Fails if the arm cannot
/// have a twin, or if the file describes no arm. @param file name of the arm's file, for the comment in the text
Result<std::string> twinOf(const document::Node& root, const std::string& file);

/// [main] Returns a sentence about the numbers of the twin that are those of another arm, because the arm's file lacks
/// them; "" if there are none.
std::string borrowedByTwin(const document::Node& root);

}  // namespace hapticd::diagnostics
