// SPDX-License-Identifier: MIT
/// CAD files: `hapticd-import` as a child with limits, so that no file can do more than fail.
#pragma once
#include <string>

namespace hapticd::cli {

struct CadImport {
  std::string file, out;
  bool check = false;       ///< writes nothing, but reports what would be lost
  bool json = false;        ///< the report for programs
  double memory_mb = 4096;  ///< most memory that the child may use
  double time_s = 600;      ///< longest time that the child may take
};

/// [any] True if the file's name ends as those of the CAD files that are read.
bool isCadFile(const std::string& file);

/// [main] Converts a file and prints the report or the error. @return the exit code
int importCad(const CadImport& options);

}  // namespace hapticd::cli
