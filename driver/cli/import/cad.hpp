// SPDX-License-Identifier: MIT
/// Imports CAD files. `hapticd-import` runs as a child process with limits, so that a bad file can only make the import
/// fail.
#pragma once
#include <string>

#include "import/bezier_import.hpp"

namespace hapticd::cli {

struct CadImport {
  std::string file, out;
  std::string named;               ///< what messages call the result; "": `out`
  bool check = false;              ///< true: writes nothing, and only reports what would be lost
  bool json = false;               ///< true prints the report for programs
  importing::Placement placement;  ///< `scale` is a factor on top of the unit of the file
  double memory_mb = 4096;         ///< most memory that the child may use
  double time_s = 600;             ///< longest time that the child may take
};

/// [any] Returns true if the name of the file ends like that of a CAD file that can be read.
bool isCadFile(const std::string& file);

/// [main] Converts a file and prints the report or the error. @return the exit code
int importCad(const CadImport& options);

}  // namespace hapticd::cli
