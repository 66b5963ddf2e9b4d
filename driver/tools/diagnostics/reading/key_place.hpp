// SPDX-License-Identifier: MIT
/// Finds the line of a file in which a key stands.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "description/scene.hpp"
#include "document/node.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the place of a key such as "servo.velocity.parameter" or "devices[1].mount" in a file; nothing if the
/// file does not have it.
std::optional<document::Place> placeOfKey(const std::filesystem::path& file, const std::string& key);

/// [main] Does the same in a file that was read already. @param root its tree
std::optional<document::Place> placeOfKey(const document::Node& root, const std::filesystem::path& file,
                                          const std::string& key);

/// [main] Returns the place of a key in the file of a model; the place of the model if the file does not have the key.
document::Place placeInModel(const scene::Model& model, const std::string& key);

/// [main] Reports a problem of a model at one of its keys. @param index of the model in the scene
/// @param key below the model, such as "pose.position"
void reportInModel(document::Problems& problems, const scene::Scene& scene, size_t index, const char* key,
                   const std::string& what);

}  // namespace hapticd::diagnostics
