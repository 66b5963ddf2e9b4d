/// What only a device module can judge of its device file, found without touching hardware.
#pragma once
#include <filesystem>

#include "scene/problem.hpp"

namespace hapticd::cli {

/// [main] Gives the parameters to the module; what it refuses is placed in the file by the key that it names.
scene::Problems tryDevice(const std::filesystem::path& file);

}  // namespace hapticd::cli
