// SPDX-License-Identifier: MIT
/// What a program beside a test prints.
#pragma once
#include <cstdio>
#include <string>

namespace hapticd::record {

/// Returns the standard output of a command of the shell; "failed: " before it if its exit code is not 0.
inline std::string outputOf(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  char buffer[256];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  return pclose(pipe) == 0 ? text : "failed: " + text;
}

}  // namespace hapticd::record
