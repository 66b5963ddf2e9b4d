// SPDX-License-Identifier: MIT
/// Reads files with problems as far as possible, so that further checks can find more problems in them.
#pragma once
#include <filesystem>
#include <optional>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::scene {

/// [main] Returns the device with those parameters that are right; nothing if the file is not a device file, or if its
/// module is unknown.
std::optional<Device> deviceDraft(const std::filesystem::path& file, host::Catalog& catalog);

/// [main] Returns the scene with everything that is right, also in models with a problem; nothing if the file is not a
/// scene.
std::optional<Scene> sceneDraft(const std::filesystem::path& file, host::Catalog& catalog);

}  // namespace hapticd::scene
