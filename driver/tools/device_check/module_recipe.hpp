// SPDX-License-Identifier: MIT
/// Makes devices from a module file alone, without a device file, with default parameters.
#pragma once
#include <filesystem>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::device_check {

/// [main] Returns one device for each device class of the file. A child process loads the file to describe its classes.
Result<std::vector<scene::Device>> devicesIn(const std::filesystem::path& file);

}  // namespace hapticd::device_check
