// SPDX-License-Identifier: MIT
/// Distinguishes a plugin's file from what people give in its place: a folder, the name of a plugin, a scene.
#pragma once
#include <string>

namespace hapticd::cli {

/// [main] Returns why a path is not the file of a plugin, and which one was probably meant; "" if it is a shared
/// object.
std::string whyNoPlugin(const std::string& path);

}  // namespace hapticd::cli
