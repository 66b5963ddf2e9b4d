// SPDX-License-Identifier: MIT
/// `hapticd import` of a triangle mesh into a part file.
#pragma once
#include <string>

#include "import/bezier_import.hpp"

namespace hapticd::cli {

struct MeshImport {
  std::string file, out;
  importing::Placement placement;
  double smooth_angle = 0;  ///< [degrees]
  bool json = false;        ///< the report as JSON
};

/// [main] Returns the exit code; everything else has been printed.
int importMesh(const MeshImport& options);

}  // namespace hapticd::cli
