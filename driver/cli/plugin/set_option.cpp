// SPDX-License-Identifier: MIT
#include "cli/plugin/set_option.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "document/node.hpp"
#include "document/reader.hpp"
#include "document/suggestion.hpp"
#include "hapticd/abi.h"
#include "scene/parameters.hpp"

namespace hapticd::cli {
namespace {

using document::Problem;

/// Returns what a message shows as the value of a parameter that has no value.
const char* placeholder(uint32_t kind) {
  switch (kind) {
    case HSP_PATH:
      return "FILE";
    case HSP_ARRAY:
      return "[NUMBER, ...]";
    case HSP_REAL:
    case HSP_INT:
      return "NUMBER";
    default:
      return "VALUE";
  }
}

/// Returns the shortest array that the table of the plugin allows, of numbers that it allows, such as "[[0, 0]]".
std::string exampleOf(const host::ParamInfo& param) {
  const uint32_t columns = std::max(param.columns, 1u), rows = std::max(1u, (param.min_count + columns - 1) / columns);
  const std::string number = fmt::format("{:g}", std::clamp(0.0, param.min, param.max));
  std::string row, all;
  for (uint32_t i = 0; i < columns; ++i) row += (i > 0 ? ", " : "") + number;
  if (columns == 1 || param.max_count <= columns) {
    for (uint32_t i = 0; i < rows; ++i) all += (i > 0 ? ", " : "") + row;
    return "[" + all + "]";
  }
  for (uint32_t i = 0; i < rows; ++i) all += (i > 0 ? ", [" : "[") + row + "]";
  return "[" + all + "]";
}

std::vector<std::string> namesOf(const std::vector<host::ClassInfo>& classes) {
  std::set<std::string> names;
  for (const host::ClassInfo& info : classes)
    for (const host::ParamInfo& param : info.params) names.insert(param.id);
  return {names.begin(), names.end()};
}

}  // namespace

SetOption::SetOption(const std::vector<std::string>& pairs, const std::vector<host::ClassInfo>& classes) {
  const std::vector<std::string> names = namesOf(classes);
  for (const std::string& pair : pairs) {
    const size_t equals = pair.find('=');
    const std::string id = pair.substr(0, equals);
    if (equals == std::string::npos)
      problems_.push_back("--set " + pair + ": has no value, expected ID=VALUE");
    else if (std::find(names.begin(), names.end(), id) == names.end())
      problems_.push_back("--set " + pair + ": unknown parameter, expected one of " +
                          document::listedFor(id, names, 24) + document::suggestion(id, names));
    else if (!given_.emplace(id, pair.substr(equals + 1)).second)
      problems_.push_back("--set " + pair + ": " + id + " is given twice, expected once");
  }
}

std::vector<scene::Value> SetOption::valuesFor(const host::ClassInfo& info) {
  document::Problems wrong;
  // Paths are relative to the folder of the reader's file, which is the current folder here.
  document::Reader in(std::filesystem::current_path() / "--set", wrong);
  scene::ParameterReader reader(in, info);
  for (const auto& [id, text] : given_) {
    const int index = info.indexOf(id);
    if (index < 0) continue;
    const size_t before = wrong.size();
    const auto node = document::parseText(text, in.file().string(), wrong);
    if (node && !node->isNull()) reader.readOne(*node, id, static_cast<uint32_t>(index));
    if (node && node->isNull()) document::report(wrong, in.place(*node), id, "no value given, expected ID=VALUE");
    for (size_t i = before; i < wrong.size(); ++i)
      problems_.push_back("--set " + id + "=" + text + ": " + (wrong[i].key == id ? "" : wrong[i].key + ": ") +
                          wrong[i].what);
  }
  std::vector<scene::Value> values = reader.take();
  for (scene::Value& value : values) value.place = {};
  return values;
}

std::vector<std::string> missing(const host::ClassInfo& info, const std::vector<scene::Value>& values) {
  std::vector<std::string> missing;
  for (const host::ParamInfo& param : info.params) {
    const bool has = givenIn(values, param.id) != nullptr;
    if (has || (param.flags & HSP_P_REQUIRED) == 0) continue;
    missing.push_back("plugin '" + info.name + "' needs the parameter " + param.id + " (" + param.doc +
                      "); give --set " + param.id + "=" + placeholder(param.kind));
  }
  return missing;
}

std::vector<EmptyArray> emptyArrays(const host::ClassInfo& info, const std::vector<scene::Value>& values) {
  std::vector<EmptyArray> found;
  for (const host::ParamInfo& param : info.params) {
    const bool has = givenIn(values, param.id) != nullptr;
    const std::string initial = param.def_text.value_or("");
    const bool empty = initial.find_first_not_of(" []") == std::string::npos;
    if (has || !empty || param.kind != HSP_ARRAY || (param.flags & HSP_P_REQUIRED) != 0) continue;
    found.push_back({param.id, "'" + param.id + "=" + exampleOf(param) + "'"});
  }
  return found;
}

}  // namespace hapticd::cli
