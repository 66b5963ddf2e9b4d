// SPDX-License-Identifier: MIT
#include "host/built_in.hpp"

namespace hapticd::host {
namespace {

std::span<const BuiltIn> list;

std::filesystem::path pathOf(const BuiltIn& built_in) {
  return std::filesystem::path(kBuiltInFolder) / built_in.name;
}

}  // namespace

void setBuiltIns(std::span<const BuiltIn> all) {
  list = all;
}

const BuiltIn* findBuiltIn(const std::filesystem::path& path) {
  for (const BuiltIn& built_in : list)
    if (path == pathOf(built_in)) return &built_in;
  return nullptr;
}

std::vector<std::filesystem::path> builtIns(Kind kind) {
  std::vector<std::filesystem::path> paths;
  for (const BuiltIn& built_in : list)
    if (kind == Kind::kShape ? built_in.shapes != nullptr : built_in.devices != nullptr)
      paths.push_back(pathOf(built_in));
  return paths;
}

}  // namespace hapticd::host
