// SPDX-License-Identifier: MIT
/// Old defaults of parameters, for recordings of plugin versions that had other defaults than today.
#pragma once
#include <string>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [main] For an old recording: sets parameters for which the scene gave no value to the defaults that the plugin had
/// in that version, so that a replay gives the same forces. @param version version of the plugin in the recorded run
void useFormerDefaults(scene::Model& model, const std::string& plugin_id, const std::string& version);

}  // namespace hapticd::servo
