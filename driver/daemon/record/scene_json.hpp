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

/// [main] Returns JSON of one model in the characters of ASCII, so that it can be cut anywhere.
std::string modelToJson(const scene::Model& model);
Result<scene::Model> modelFromJson(const std::string& json_text);  ///< [main]

}  // namespace hapticd::record
