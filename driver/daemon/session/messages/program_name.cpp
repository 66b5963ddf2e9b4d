// SPDX-License-Identifier: MIT
#include "session/messages/program_name.hpp"

#include <fstream>

namespace hapticd::servo {

namespace {

std::string fileOf(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

bool interprets(const std::string& name) {
  for (const char* known : {"python", "perl", "ruby", "node", "octave", "julia"})
    if (name.compare(0, std::string(known).size(), known) == 0) return true;
  return false;
}

/// Replaces characters that cannot be printed, because a process can write anything into its command line.
std::string printable(std::string name) {
  constexpr size_t kMost = 48;
  name.resize(std::min(name.size(), kMost));
  for (char& c : name)
    if (c < ' ' || c > '~') c = '?';
  return name.empty() ? "?" : name;
}

}  // namespace

std::string programOf(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/cmdline", std::ios::binary);
  std::string program, script;
  std::getline(in, program, '\0');
  program = fileOf(program);
  if (interprets(program) && std::getline(in, script, '\0') && !script.empty() && script[0] != '-')
    program += " " + fileOf(script);
  return printable(program);
}

}  // namespace hapticd::servo
