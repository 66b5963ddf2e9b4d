// SPDX-License-Identifier: MIT
/// Where a file says what a key names.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] The place of "servo.velocity.parameter" or "devices[1].mount" in a file; nothing if it is not there.
std::optional<document::Place> placeOfKey(const std::filesystem::path& file, const std::string& key);

}  // namespace hapticd::diagnostics
