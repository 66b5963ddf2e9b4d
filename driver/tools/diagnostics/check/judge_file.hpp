// SPDX-License-Identifier: MIT
/// Judges one file as `hapticd check` does: finds every problem at once, and warns of what was hardly meant.
#pragma once
#include <string>

#include "diagnostics/check/check_result.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Judges a scene, device or daemon file. Modules and plugins are called in child processes.
CheckResult judgeFile(const std::string& file, const CheckOptions& options, host::Catalog& catalog);

}  // namespace hapticd::diagnostics
