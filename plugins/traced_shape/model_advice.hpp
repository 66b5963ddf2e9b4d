// SPDX-License-Identifier: MIT
/// Warnings for values in a model file that its format allows, but that nobody can mean.
#pragma once
#include <string>
#include <vector>

#include "model_file.hpp"

namespace hapticd {

/// [main] Finds a size in another unit, a surface without area, a mistyped name or weight, and a corner that misses its
/// neighbour.
/// @param text of the file, to find the lines
/// @param name of the file, for messages
/// @return warnings of the form `file:line:column: key: what`
std::vector<std::string> adviseModel(const ModelFile& file, const trace::Model& model, const std::string& text,
                                     const std::string& name);

/// [main] Does the same for the surfaces of a file with problems. @param sound true for each surface that was read; its
/// neighbours may be missing
std::vector<std::string> adviseSurfaces(const ModelFile& file, const std::vector<bool>& sound, const std::string& text,
                                        const std::string& name);

}  // namespace hapticd
