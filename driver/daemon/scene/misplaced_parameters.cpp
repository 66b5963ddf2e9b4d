// SPDX-License-Identifier: MIT
#include "scene/misplaced_parameters.hpp"

#include <string>

namespace hapticd::scene::detail {

using namespace document;
namespace {

/// Returns the id of the parameter or the name of the group of parameters that a key at the top stands for; "" if the
/// module has none, or several.
std::string idOf(const std::string& key, const host::ClassInfo& info) {
  const std::string group = key + ".", end = "." + key;
  std::string found;
  for (const host::ParamInfo& param : info.params) {
    if (param.id == key || param.id.starts_with(group)) return key;
    if (!param.id.ends_with(end)) continue;
    if (!found.empty()) return "";
    found = param.id;
  }
  return found;
}

/// Returns a value as in a file, if it is short: "true", or "{verified: true}".
std::string shortText(const Node& value) {
  const auto quoted = [](const std::string& text) {  // YAML reads 1234:0006 as a number
    return text.find(':') == text.npos ? text : '\"' + text + '\"';
  };
  if (value.isScalar()) return quoted(value.scalar);
  if (!value.isMap() || value.entries.size() != 1 || !value.entries[0].value.isScalar()) return "...";
  return "{" + value.entries[0].key.scalar + ": " + quoted(value.entries[0].value.scalar) + "}";
}

/// Returns the lines that a file should have: "parameters: {device: {verified: true}}".
std::string inItsPlace(std::string id, const Node& value) {
  std::string text = "parameters: {", end = "}";
  for (size_t dot; (dot = id.find('.')) != id.npos; id.erase(0, dot + 1)) text += id.substr(0, dot) + ": {", end += "}";
  return text + id + ": " + shortText(value) + end;
}

}  // namespace

void placeParameters(const Node& root, const host::ClassInfo& info, Reader& in) {
  if (!root.isMap()) return;
  for (const Entry& entry : root.entries) {
    const std::string id = idOf(entry.key.scalar, info);
    if (id.empty()) continue;
    for (Problem& one : in.problems())
      if (one.kind == ProblemKind::kUnknownKey && one.key == entry.key.scalar && one.place.line == entry.key.line &&
          one.place.file == in.file().string())
        one.what = "unknown key at the top of a device file; it is a parameter of " + info.name + ": expected " +
                   inItsPlace(id, entry.value);
  }
}

}  // namespace hapticd::scene::detail
