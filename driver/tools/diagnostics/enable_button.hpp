// SPDX-License-Identifier: MIT
/// The dead-man button of a device file: whether the arm that the file describes has it.
#pragma once
#include <string>

#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Notes limits.enable.button if no field of parameters.wire.input is that button. A file without a wire format
/// says nothing about its buttons, so `run` finds out.
void checkEnableButton(const document::Node& root, const std::string& file, document::Problems& problems);

/// [any] What to press: "button 0 (counted from 0; button: 1 of a wire format)".
std::string enableButtonText(int button);

}  // namespace hapticd::diagnostics
