// SPDX-License-Identifier: MIT
/// What the file of a soft body says that its format allows and nobody can mean.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "medial_file.hpp"

namespace hapticd {

/// [main] Grams for kilograms, millimetres for metres, megapascals for pascals: each as `file:line:column: key: what`.
/// @param medial the tree that the body was read from  @param text of the file, for the lines
std::vector<std::string> adviseMedial(const MedialFile& file, const nlohmann::json& medial, const std::string& text,
                                      const std::string& name);

}  // namespace hapticd
