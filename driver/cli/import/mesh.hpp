// SPDX-License-Identifier: MIT
/// `hapticd import` for triangle meshes: converts one into a part file.
#pragma once
#include <string>

#include "import/bezier_import.hpp"

namespace hapticd::cli {

struct MeshImport {
  std::string file, out;
  std::string named;  ///< what messages call the result; "": `out`
  importing::Placement placement;
  double smooth_angle = 0;  ///< [degrees] see MeshOptions::smooth_angle
  bool json = false;        ///< true prints the report as JSON
  bool felt = true;         ///< false leaves out what only a hand needs: the empty balls
};

/// [main] Prints each line of an error as an error of its own. @return the given exit code
int failLines(int exit_code, const std::string& lines);

/// [main] Warns if what was imported is larger or smaller than a hand can feel. @param size [m] diagonal of its box
void warnOfSize(const std::string& out, double size);

/// [main] Says which unit was assumed, unless a size was asked for. @param largest [m] extent of what was imported
void printUnit(const importing::Placement& placement, double largest);

/// [main] Converts the mesh and prints the report or the error. @return the exit code
int importMesh(const MeshImport& options);

}  // namespace hapticd::cli
