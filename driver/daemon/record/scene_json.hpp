// SPDX-License-Identifier: MIT
/// Converts a loaded scene to JSON and back without any loss. A recording contains this JSON, so that a replay needs
/// neither the YAML files nor the options of the recorded run.
#pragma once
#include <string>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::record {

std::string sceneToJson(const scene::Scene& scene);                ///< [main]
Result<scene::Scene> sceneFromJson(const std::string& json_text);  ///< [main] its error says what is missing

}  // namespace hapticd::record
