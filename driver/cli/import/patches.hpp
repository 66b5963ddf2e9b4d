// SPDX-License-Identifier: MIT
/// `hapticd import` for Bezier patches: converts them into a model file.
#pragma once
#include <string>

#include "import/bezier_import.hpp"

namespace hapticd::cli {

struct PatchImport {
  std::string file, out;  ///< `out` -: standard output
  std::string named;      ///< what messages call the result; "": `out`
  importing::Placement placement;
  std::string outward = "auto";  ///< auto, normal or reversed
};

/// [main] Converts the patches and prints the report or the error. @return the exit code
int importPatches(const PatchImport& options);

}  // namespace hapticd::cli
