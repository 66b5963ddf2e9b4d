// SPDX-License-Identifier: MIT
/// Loads a device file for a command, and prints everything that is wrong with it.
#pragma once
#include <optional>
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::cli {

/// [main] Returns the problems of a device file that `hapticd check` reports, also those that only its module can find.
/// Touches no hardware.
document::Problems problemsOfDevice(const std::string& file);

/// [main] Loads a device file, or prints every problem on standard error and returns nothing.
std::optional<scene::Device> loadDeviceOrReport(const std::string& file);

}  // namespace hapticd::cli
