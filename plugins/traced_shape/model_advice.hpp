// SPDX-License-Identifier: MIT
/// What a model file says that its format allows and nobody can mean.
#pragma once
#include <string>
#include <vector>

#include "model_file.hpp"

namespace hapticd {

/// [main] A size of another unit, a surface without area, a name or a weight that is a slip, a corner that misses its
/// neighbour: each as `file:line:column: key: what`.
/// @param text of the file, for the lines  @param name of the file, for messages
std::vector<std::string> adviseModel(const ModelFile& file, const trace::Model& model, const std::string& text,
                                     const std::string& name);

}  // namespace hapticd
