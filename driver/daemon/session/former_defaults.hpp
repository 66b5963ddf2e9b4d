// SPDX-License-Identifier: MIT
/// Defaults of parameters that newer versions of a plugin have changed.
#pragma once
#include <string>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] Gives a recorded model the defaults that its plugin had then, where the scene gave no value, so that an old
/// recording gives the same answers. @param plugin_id, version of the plugin that made the recording
void useFormerDefaults(scene::Model& model, const std::string& plugin_id, const std::string& version);

}  // namespace hapticd::servo
