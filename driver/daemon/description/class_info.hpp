// SPDX-License-Identifier: MIT
/// What a plugin or module file says of itself, copied out of it: valid whether the file is loaded or not.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hapticd::host {

enum class Kind : uint8_t { kShape, kDevice };

/// hsp_param with owned strings.
struct ParamInfo {
  std::string id, unit, doc;
  uint32_t kind = 0, flags = 0;
  double min = 0, max = 0, def = 0;
  std::vector<std::string> choices;
  uint32_t columns = 0, min_count = 0, max_count = 0;
  std::optional<std::string> def_text;
};

/// hsp_class or hdv_class with owned strings.
struct ClassInfo {
  Kind kind = Kind::kShape;
  std::string id, name, version, license, doc;
  uint32_t flags = 0, abi_minor = 0;
  std::vector<ParamInfo> params;
  std::filesystem::path file;

  /// Index of a parameter, or -1.
  int indexOf(const std::string& param) const;
  std::vector<std::string> paramIds() const;
};

}  // namespace hapticd::host
