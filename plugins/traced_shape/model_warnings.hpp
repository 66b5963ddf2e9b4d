// SPDX-License-Identifier: MIT
/// Warnings for values in a model file that its format allows, but that are surely mistakes.
#pragma once
#include <string>
#include <vector>

#include "model_file.hpp"

namespace hapticd {

/// [main] Finds sizes that seem to be in another unit, surfaces without area, names and weights that seem mistyped, and
/// corners that miss those of their neighbours.
/// @param text the text of the file, in which the lines of the values are found
/// @param name the name of the file, for the warnings
/// @return warnings of the form `file:line:column: key: what`
std::vector<std::string> warnOfModel(const ModelFile& file, const trace::Model& model, const std::string& text,
                                     const std::string& name);

/// [main] Returns the warnings of the model about surfaces that join others, each at the place of the last surface that
/// it names.
std::vector<std::string> warnOfJoints(const ModelFile& file, const trace::Model& model, const std::string& text,
                                      const std::string& name);

/// [main] Does the same as warnOfModel() for the surfaces that could be read, if the file has problems.
/// @param sound for each surface of the file: true if it could be read. A surface that was read may have neighbours
/// that were not
std::vector<std::string> warnOfSurfaces(const ModelFile& file, const std::vector<bool>& sound, const std::string& text,
                                        const std::string& name);

}  // namespace hapticd
