// SPDX-License-Identifier: MIT
#include "watch/quarantine.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>

namespace hapticd::watch {

namespace fs = std::filesystem;

fs::path stateFolder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  fs::path dir = variable("STATE_DIRECTORY");
  if (dir.empty() && !variable("XDG_STATE_HOME").empty()) dir = fs::path(variable("XDG_STATE_HOME")) / "hapticd";
  if (dir.empty() && !variable("HOME").empty()) dir = fs::path(variable("HOME")) / ".local/state/hapticd";
  return dir;
}

fs::path stateDir() {
  const fs::path dir = stateFolder();
  std::error_code code;
  fs::create_directories(dir, code);
  return !dir.empty() && access(dir.c_str(), W_OK) == 0 ? dir : fs::path();
}

std::string QuarantinedPlugin::fileForPeople() const {
  std::istringstream parts(file);
  long long bytes = 0, seconds = 0;
  std::string word, of, fraction, path;
  if (!(parts >> bytes >> word >> of >> seconds >> fraction >> std::ws) || !std::getline(parts, path)) return file;
  const auto built = static_cast<std::time_t>(seconds);
  std::tm time{};
  char text[48];
  if (gmtime_r(&built, &time) == nullptr || std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &time) == 0)
    return path;
  return path + " of " + text + ", " + std::to_string(bytes) + " bytes";
}

std::vector<QuarantinedPlugin> quarantined(const fs::path& dir) {
  std::vector<QuarantinedPlugin> list;
  std::ifstream in(dir / kQuarantineFile);
  for (std::string line; std::getline(in, line);) {
    std::istringstream parts(line);
    QuarantinedPlugin read;
    std::getline(parts, read.plugin, '\t');
    std::getline(parts, read.reason, '\t');
    std::getline(parts, read.file);
    const bool known = std::any_of(list.begin(), list.end(), [&](const auto& entry) {
      return entry.plugin == read.plugin && entry.file == read.file;
    });
    if (!read.plugin.empty() && !known) list.push_back(std::move(read));
  }
  return list;
}

Result<bool> clearQuarantine(const fs::path& dir, const std::string& plugin) {
  const std::vector<QuarantinedPlugin> before = quarantined(dir);
  const fs::path file = dir / kQuarantineFile, part = dir / (std::string(kQuarantineFile) + ".part");
  std::ofstream out(part);
  size_t kept = 0;
  for (const QuarantinedPlugin& entry : before)
    if (entry.plugin != plugin) {
      out << entry.plugin << '\t' << entry.reason << (entry.file.empty() ? "" : "\t" + entry.file) << '\n';
      ++kept;
    }
  out.close();
  std::error_code code;
  if (out) fs::rename(part, file, code);
  if (!out || code) return Error{file.string() + ": cannot be written" + (code ? ": " + code.message() : "")};
  return kept < before.size();
}

}  // namespace hapticd::watch
