// SPDX-License-Identifier: MIT
/// Model files: the surfaces that a scene's `geometry` names.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/spline/surface_data.hpp"
#include "kernels/trace/model.hpp"

namespace hapticd {

/// What a file of format hapticd-model/1 says about its surfaces.
struct ModelFile {
  std::vector<spline::SurfaceData> surfaces;  ///< at least one, each valid
  std::vector<trace::EdgeLink> edges;         ///< stated adjacency; the rest is found by geometry
};

/// All that is wrong with a model file, one problem a line: `file:line:column: key: what, expected what`.
class ModelFileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// [main] Reads a model file, YAML or JSON (the same structure).
/// @throws ModelFileError with every problem found; whatever the bytes of the file.
ModelFile readModelFile(const std::string& path);

/// [main] The same from the text of a file; `name` stands in messages.
ModelFile parseModelFile(const std::string& text, const std::string& name);

}  // namespace hapticd
