// SPDX-License-Identifier: MIT
/// The classes that a plugin or module file describes. The description is a copy, so it is valid even if the file is
/// not loaded.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hapticd::host {

enum class Kind : uint8_t { kShape, kDevice };

/// A copy of an hsp_param that owns its strings.
struct ParamInfo {
  std::string id, unit, doc;
  uint32_t kind = 0, flags = 0;
  double min = 0, max = 0, def = 0;
  std::vector<std::string> choices;
  uint32_t columns = 0, min_count = 0, max_count = 0;
  std::optional<std::string> def_text;
};

/// A copy of an hsp_class or hdv_class that owns its strings.
struct ClassInfo {
  Kind kind = Kind::kShape;
  std::string id, name, version, license, doc;
  uint32_t flags = 0, abi_minor = 0;
  std::vector<ParamInfo> params;
  std::filesystem::path file;

  /// Returns the index of a parameter, or -1 if there is none.
  int indexOf(const std::string& param) const;
  std::vector<std::string> paramIds() const;
  /// Returns the unit of a parameter, or "" if there is no such parameter.
  std::string unitOf(const std::string& param) const;
};

}  // namespace hapticd::host
