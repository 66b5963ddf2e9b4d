// SPDX-License-Identifier: MIT
/// The devices of a module file alone, without a device file: their parameters are the defaults.
#pragma once
#include <filesystem>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::device_check {

/// [main] One recipe for each device class of the file, which a child process describes.
Result<std::vector<scene::Device>> devicesIn(const std::filesystem::path& file);

}  // namespace hapticd::device_check
