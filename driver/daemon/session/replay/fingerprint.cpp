// SPDX-License-Identifier: MIT
#include "session/replay/fingerprint.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "base/regular_file.hpp"
#include "hapticd/abi.h"

namespace hapticd::servo {

std::string fingerprint(const std::string& file) {
  const auto fd = openRegular(file);
  if (!fd) return "";
  uint64_t hash = 0xcbf29ce484222325;
  char buffer[1 << 14];
  for (ssize_t got = 0; (got = read(*fd, buffer, sizeof buffer)) > 0;)
    for (ssize_t i = 0; i < got; ++i) hash = (hash ^ static_cast<unsigned char>(buffer[i])) * 0x100000001b3;
  close(*fd);
  return fmt::format("{:016x}", hash);
}

std::vector<std::string> filesOf(const scene::Model& model) {
  constexpr uint32_t kPath = HSP_PATH;
  std::vector<std::string> files = {model.library.string()};
  for (const scene::Value& value : model.parameters)
    if (value.kind == kPath && !value.text.empty()) files.push_back(value.text);
  return files;
}

}  // namespace hapticd::servo
