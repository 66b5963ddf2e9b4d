// SPDX-License-Identifier: MIT
/// Finds problems of a device file that only its module can judge, without touching hardware.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// What a module said when it got its parameters.
struct ModuleTrial {
  std::string error;                ///< "" if an instance can be made; otherwise a line for each thing that is wrong
  std::vector<std::string> doubts;  ///< what is no error, but was hardly meant
};

/// [main] Makes an instance in a child process and tests its kinematics there. If the module crashes or hangs, the
/// error names the module and the call. Touches no hardware.
ModuleTrial tryModule(const scene::Device& device);

/// [main] Gives the parameters to the module, and returns a problem for each that it refuses, at the place of the key
/// that the module names. @param known problems that reading the file has found; what the module says about them is
/// left out @param warnings gets the doubts; nullptr if they are not wanted
document::Problems tryDevice(const std::filesystem::path& file, host::Catalog& catalog,
                             const document::Problems& known = {}, document::Problems* warnings = nullptr);

}  // namespace hapticd::diagnostics
