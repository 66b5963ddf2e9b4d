// SPDX-License-Identifier: MIT
/// Reads files that have problems, as far as they can be understood, so that further checks can find more problems in
/// them.
#pragma once
#include <filesystem>
#include <optional>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::scene {

/// [main] Returns the device without the parameters that are wrong. A number that is out of range is replaced by the
/// nearest number in the range, and a misspelt name of a module by the nearest name. Returns nothing if the file is not
/// a device file, or if its module is unknown.
std::optional<Device> deviceDraft(const std::filesystem::path& file, host::Catalog& catalog);

/// [main] Returns the scene without the values that are wrong. A model with a problem is kept, with its other values.
/// Returns nothing if the file is not a scene.
std::optional<Scene> sceneDraft(const std::filesystem::path& file, host::Catalog& catalog);

}  // namespace hapticd::scene
