// SPDX-License-Identifier: MIT
/// Reads files with problems as far as possible, so that further checks can find more problems in them.
#pragma once
#include <filesystem>
#include <optional>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::scene {

/// [main] Returns the device with those parameters that are right, and with numbers that are out of range at the
/// nearest one in it; nothing if the file is not a device file, or if its module is unknown. A misspelt name of a
/// module stands for the nearest one.
std::optional<Device> deviceDraft(const std::filesystem::path& file, host::Catalog& catalog);

/// [main] Returns the scene with everything that is right, also in models with a problem; nothing if the file is not a
/// scene.
std::optional<Scene> sceneDraft(const std::filesystem::path& file, host::Catalog& catalog);

}  // namespace hapticd::scene
