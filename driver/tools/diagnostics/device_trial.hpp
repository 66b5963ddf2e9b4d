// SPDX-License-Identifier: MIT
/// What only a device module can judge of its device file, found without touching hardware.
#pragma once
#include <filesystem>

#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Gives the parameters to the module; what it refuses is placed in the file by the key that it names.
/// @param known what reading the file has told already: a module's words about that are left out
document::Problems tryDevice(const std::filesystem::path& file, host::Catalog& catalog,
                             const document::Problems& known = {});

}  // namespace hapticd::diagnostics
