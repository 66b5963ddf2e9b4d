// SPDX-License-Identifier: MIT
/// Checks whether an arm has the buttons and joints that its device file uses: the enable (dead-man) button, and those
/// for HDAPI programs.
#pragma once
#include <string>

#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Adds a problem if no field of parameters.wire.input is the button limits.enable.button. A file without a wire
/// format does not describe its buttons, so only `run` can check it.
void checkEnableButton(const document::Node& root, const std::string& file, document::Problems& problems);

/// [main] Adds a problem for each joint and button under the key `hd` that the wire format of the arm does not have.
void checkHd(const document::Node& root, const std::string& file, document::Problems& problems);

/// [any] Returns the name of a button: "button 0 (counted from 0; button: 1 of a wire format)".
std::string enableButtonText(int button);

}  // namespace hapticd::diagnostics
