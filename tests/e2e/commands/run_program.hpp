// SPDX-License-Identifier: MIT
/// Runs the program `hapticd` as a user does and gives back what it printed.
#pragma once
#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace hapticd::test {

struct Outcome {
  std::string text;  ///< standard output and error, in the order printed
  int exit_code = -1;
  int signal = 0;  ///< that ended it; 0: none
};

/// @param arguments as a shell takes them, before the program's name `environment` ("A=b C=d")
inline Outcome run(const std::string& arguments, const std::string& environment = "") {
  // `exec` so that a signal ends what popen started and is not turned into an exit code of the shell.
  const std::string command = "exec env HAPTICD_CONFIG= HAPTICD_PLUGIN_PATH=" TEST_MODULES "/good:" TEST_MODULES
                              "/bad " +
                              environment + " " HAPTICD_PROGRAM " " + arguments + " 2>&1 </dev/null";
  Outcome outcome;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  char buffer[4096];
  for (size_t got = 0; (got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) outcome.text.append(buffer, got);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  return outcome;
}

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace hapticd::test
