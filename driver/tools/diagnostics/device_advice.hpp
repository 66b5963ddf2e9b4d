// SPDX-License-Identifier: MIT
/// What is allowed in a device file and yet hardly meant: told as warnings, without touching hardware.
#pragma once
#include <filesystem>

#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Warnings of a device file without problems: `limits.force` above what the arm gives, positions of whole
/// numbers without a scale, and a `limits.workspace` that leaves out the tip of the arm at rest.
document::Problems adviseDevice(const std::filesystem::path& file, host::Catalog& catalog);

}  // namespace hapticd::diagnostics
