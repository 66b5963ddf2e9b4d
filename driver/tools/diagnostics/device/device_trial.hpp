// SPDX-License-Identifier: MIT
/// Finds problems of a device file that only its module can find, without touching hardware.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// The messages of a module about its parameters.
struct ModuleTrial {
  std::string error;                ///< "" if an instance can be made; otherwise a line for each thing that is wrong
  std::vector<std::string> doubts;  ///< warnings about values that are allowed but were hardly meant
};

/// [main] Makes an instance in a child process and tests its kinematics there. If the module crashes or hangs, the
/// error names the module and the call. Touches no hardware.
ModuleTrial tryModule(const scene::Device& device);

/// [main] Gives the parameters to the module, and returns a problem for each that the module refuses, with the line and
/// column of its key.
/// @param known problems that were found when the file was read; messages of the module about the same keys are left
/// out
/// @param warnings receives the warnings of the module; may be nullptr
document::Problems tryDevice(const std::filesystem::path& file, host::Catalog& catalog,
                             const document::Problems& known = {}, document::Problems* warnings = nullptr);

}  // namespace hapticd::diagnostics
