// SPDX-License-Identifier: MIT
/// A loaded scene as JSON and back, to the last bit: a recording carries it, so that a replay needs no YAML file, no
/// daemon file and no option of the recorded run.
#pragma once
#include <string>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::record {

std::string sceneToJson(const scene::Scene& scene);                ///< [main]
Result<scene::Scene> sceneFromJson(const std::string& json_text);  ///< [main] an error says what is missing

}  // namespace hapticd::record
