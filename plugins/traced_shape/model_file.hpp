// SPDX-License-Identifier: MIT
/// Model files: the surfaces in the file that `geometry` names in a scene.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/spline/surface_data.hpp"
#include "kernels/trace/model.hpp"

namespace hapticd {

/// The contents of a file of format hapticd-model/1.
struct ModelFile {
  std::vector<spline::SurfaceData> surfaces;  ///< at least one, each valid
  std::vector<trace::EdgeLink> edges;         ///< common edges that the file gives; all others are found by geometry
};

/// All problems of a model file, one per line: `file:line:column: key: what, expected what`.
class ModelFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// Warnings about the values of the file that could be read, from warnOfModel() and warnOfMedialFile().
  std::vector<std::string> odd;
};

/// [main] Reads a model file, YAML or JSON (the same structure).
/// @throws ModelFileError with every problem found, for every possible content of the file.
ModelFile readModelFile(const std::string& path);

/// [main] Does the same as readModelFile() for the text of a file; `name` appears in messages.
ModelFile parseModelFile(const std::string& text, const std::string& name);

}  // namespace hapticd
