// SPDX-License-Identifier: MIT
/// What only a device module can judge of its device file, found without touching hardware.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// What was found when a module got its parameters.
struct ModuleTrial {
  std::string error;                ///< "": an instance can be made; otherwise a line for each thing that is wrong
  std::vector<std::string> doubts;  ///< what causes no fault in a run, but is hardly intended
};

/// [main] Makes an instance in a child process, and tries its kinematics there: a module that crashes or hangs is
/// named, with the call. Touches no hardware.
ModuleTrial tryModule(const scene::Device& device);

/// [main] Gives the parameters to the module; what it refuses is placed in the file by the key that it names.
/// @param known what reading the file has told already: a module's words about that are left out
/// @param warnings where doubts go; nullptr: they are not asked for
document::Problems tryDevice(const std::filesystem::path& file, host::Catalog& catalog,
                             const document::Problems& known = {}, document::Problems* warnings = nullptr);

}  // namespace hapticd::diagnostics
