// SPDX-License-Identifier: MIT
/// A device file with problems, as far as it could be read: for those who look for more of them.
#pragma once
#include <filesystem>
#include <optional>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::scene {

/// [main] The device with the parameters that are right; nothing if its file is none or its module is unknown.
std::optional<Device> deviceDraft(const std::filesystem::path& file, host::Catalog& catalog);

/// [main] A scene with problems, as far as it could be read: a model with a problem keeps what is right. Nothing where
/// the file is no scene.
std::optional<Scene> sceneDraft(const std::filesystem::path& file, host::Catalog& catalog);

}  // namespace hapticd::scene
