// SPDX-License-Identifier: MIT
/// Warnings for values in a model file that its format allows, but that are surely mistakes.
#pragma once
#include <string>
#include <vector>

#include "model_file.hpp"

namespace hapticd {

/// [main] Finds a size in another unit, a surface without area, a mistyped name or weight, and a corner that misses its
/// neighbour.
/// @param text the text of the file, in which the lines of the values are found
/// @param name the name of the file, for the warnings
/// @return warnings of the form `file:line:column: key: what`
std::vector<std::string> warnOfModel(const ModelFile& file, const trace::Model& model, const std::string& text,
                                     const std::string& name);

/// [main] Does the same for the surfaces of a file with problems. @param sound true for each surface that was read; its
/// neighbours may be missing
std::vector<std::string> warnOfSurfaces(const ModelFile& file, const std::vector<bool>& sound, const std::string& text,
                                        const std::string& name);

}  // namespace hapticd
