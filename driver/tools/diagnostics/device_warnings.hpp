// SPDX-License-Identifier: MIT
/// Warns, without touching hardware, about what a device file may contain but its author hardly meant.
#pragma once
#include <filesystem>

#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Returns warnings about a device file: `limits.force` above what the arm gives,
/// whole-number positions without a scale, a `limits.workspace` that does not contain the tip of the arm at rest, and
/// all that the other headers here judge. @param known problems of the file that were found before; what they are about
/// is not judged, and neither is what follows from it
document::Problems warnOfDevice(const std::filesystem::path& file, host::Catalog& catalog,
                                const document::Problems& known = {});

}  // namespace hapticd::diagnostics
