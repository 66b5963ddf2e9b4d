// SPDX-License-Identifier: MIT
/// Writes a scene file with the chosen settings.
#pragma once
#include <string>

#include "base/result.hpp"
#include "tune/page.hpp"

namespace hapticd::tune {

/// [main] Writes the scene of `from` with the chosen settings to `to`, which must lie in the same folder because paths
/// in a scene are relative to it. A comment at the top says what was chosen and why. Other comments are lost.
Result<void> writeScene(const Findings& findings, const std::string& from, const std::string& to);

}  // namespace hapticd::tune
