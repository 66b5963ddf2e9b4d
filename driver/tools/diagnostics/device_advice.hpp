// SPDX-License-Identifier: MIT
/// Warns, without touching hardware, about what a device file may contain but its author hardly meant.
#pragma once
#include <filesystem>

#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Returns warnings about a device file that has no problems: `limits.force` above what the arm gives,
/// whole-number positions without a scale, a `limits.workspace` that does not contain the tip of the arm at rest, and
/// all that the other headers here judge.
document::Problems adviseDevice(const std::filesystem::path& file, host::Catalog& catalog);

}  // namespace hapticd::diagnostics
