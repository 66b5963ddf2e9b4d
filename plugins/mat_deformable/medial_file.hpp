/// Model files of soft bodies: the grid of a medial axis.
#pragma once
#include <string>

#include "kernels/medial/body.hpp"

namespace hapticd {

/// [main] Reads `medial` of a model file (format hapticd-model/1), YAML or JSON: points, radius and stiffness as grids
/// of equal rows, damping and mass too where they are given. One number instead of a grid serves all points.
/// @throws ModelFileError with every problem found, a line each; whatever the bytes of the file.
medial::BodyData readMedialFile(const std::string& path);

}  // namespace hapticd
