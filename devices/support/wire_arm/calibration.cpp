// SPDX-License-Identifier: MIT
#include "wire_arm/calibration.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace hapticd::wire_arm {
namespace {

namespace fs = std::filesystem;
constexpr const char* kFormat = "hapticd-calibration/1";

/// These characters come from the device, and must not change the folder.
std::string asFileName(std::string text) {
  for (char& c : text)
    if (!((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'))) c = '_';
  return text;
}

fs::path fileOf(const fs::path& folder, const Address& address, const Identity& identity) {
  char ids[16];
  std::snprintf(ids, sizeof ids, "%04x-%04x-", address.vendor, address.product);
  const std::string port = address.port.empty() ? "" : "@" + asFileName(address.port);
  return folder / (ids + asFileName(identity.serial) + port + ".calibration");
}

std::string bootId() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(in, id);
  return id;
}

std::string epochOf(const Identity& identity) {
  return bootId() + " " + identity.epoch;
}

}  // namespace

fs::path stateFolder() {
  if (const char* given = std::getenv("STATE_DIRECTORY"); given != nullptr && *given == '/') return given;
  if (const char* given = std::getenv("XDG_STATE_HOME"); given != nullptr && *given == '/')
    return fs::path(given) / "hapticd";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr ? home : "/") / ".local/state/hapticd";
}

Result<void> storeZero(const fs::path& folder, const Address& address, const Identity& identity,
                       const JointArray& offset, size_t count) {
  std::error_code error;
  fs::create_directories(folder, error);
  const fs::path file = fileOf(folder, address, identity), draft = file.string() + ".new";
  {
    std::ofstream out(draft);
    out << kFormat << "\n" << epochOf(identity) << "\n";
    char text[32];
    for (size_t i = 0; i < count; ++i) std::snprintf(text, sizeof text, "%.17g", offset[i]), out << text << "\n";
    if (!out.flush()) return Error{file.string() + ": cannot be written; the calibration is valid only for this run"};
  }
  fs::rename(draft, file, error);  // so that the file is either replaced as a whole or not at all
  if (error) return Error{file.string() + ": cannot be written: " + error.message()};
  return {};
}

Zero loadZero(const fs::path& folder, const Address& address, const Identity& identity, size_t count) {
  std::ifstream in(fileOf(folder, address, identity));
  std::string format, epoch, line;
  if (!std::getline(in, format) || format != kFormat || !std::getline(in, epoch) || epoch != epochOf(identity))
    return {};
  Zero zero;
  for (size_t i = 0; i < count; ++i) {
    if (!std::getline(in, line)) return {};
    char* end = nullptr;
    zero.offset[i] = std::strtod(line.c_str(), &end);
    if (end == line.c_str() || !std::isfinite(zero.offset[i])) return {};
  }
  zero.known = true;
  return zero;
}

}  // namespace hapticd::wire_arm
