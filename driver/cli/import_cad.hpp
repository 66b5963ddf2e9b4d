// SPDX-License-Identifier: MIT
/// CAD files: `hapticd-import` as a child with limits, so that no file can do more than fail.
#pragma once
#include <string>

namespace hapticd::cli {

struct CadImport {
  std::string file, out;
  bool check = false;       ///< write nothing, say what would be lost
  bool json = false;        ///< the report for programs
  double memory_mb = 4096;  ///< most memory of the child
  double time_s = 600;      ///< longest time of the child
};

/// [any] Whether a file's name ends as those of CAD files do that are read.
bool isCadFile(const std::string& file);

/// [main] Converts; prints the report or the error. @return the exit code
int importCad(const CadImport& options);

}  // namespace hapticd::cli
