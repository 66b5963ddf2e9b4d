// SPDX-License-Identifier: MIT
/// Warnings for numbers in the file of a soft body that its format allows, but that are surely mistakes.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "medial_file.hpp"
#include "traced_shape/document.hpp"

namespace hapticd {

/// [main] Finds numbers in a wrong unit, such as grams for kilograms, millimetres for metres, or megapascals for
/// pascals.
/// @param root the tree from which the body was read
/// @param problems the problems of the file; keys with a problem are not judged
/// @param text the text of the file, in which the lines of the numbers are found
/// @param name the name of the file, for the warnings
/// @return warnings of the form `file:line:column: key: what`
std::vector<std::string> warnOfMedialFile(const MedialFile& file, const nlohmann::json& root, const Problems& problems,
                                          const std::string& text, const std::string& name);

}  // namespace hapticd
