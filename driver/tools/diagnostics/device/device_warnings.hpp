// SPDX-License-Identifier: MIT
/// Warns, without touching hardware, of entries in a device file that are allowed but were hardly meant.
#pragma once
#include <filesystem>

#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the warnings about a device file: `limits.force` above the force of the arm, whole-number positions
/// without a scale, a `limits.workspace` that does not contain the tip of the arm at rest, and the warnings of the
/// other headers in this folder.
/// @param known problems of the file that were found before; keys with a problem, and values that follow from them, are
/// not judged
document::Problems warnOfDevice(const std::filesystem::path& file, host::Catalog& catalog,
                                const document::Problems& known = {});

}  // namespace hapticd::diagnostics
