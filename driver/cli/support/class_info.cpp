// SPDX-License-Identifier: MIT
#include "cli/support/class_info.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/support/command.hpp"
#include "document/reader.hpp"
#include "document/suggestion.hpp"
#include "hapticd/shape.h"

namespace hapticd::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Returns true for a parameter of several rows, whose counts are those of all their numbers together.
bool isOfRows(const host::ParamInfo& p) {
  return p.columns > 1 && p.max_count > p.columns;
}

std::string typeText(const host::ParamInfo& p) {
  switch (p.kind) {
    case HSP_REAL:
      return "number";
    case HSP_INT:
      return "whole number";
    case HSP_BOOL:
      return "true or false";
    case HSP_ENUM:
      return "one of " + document::listed(p.choices, 40);
    case HSP_PATH:
      return "path of a file";
    case HSP_TEXT:
      return "text";
    case HSP_DATA:
      return "any structure";
    case HSP_ARRAY:
      return isOfRows(p) ? "list of rows of " + std::to_string(p.columns) : "list of numbers";
    default:
      return "";
  }
}

std::string countText(const host::ParamInfo& p) {
  const uint32_t each = isOfRows(p) ? p.columns : 1, least = (p.min_count + each - 1) / each, most = p.max_count / each;
  const std::string noun = isOfRows(p) ? " rows" : " numbers",
                    of = isOfRows(p) ? " of " + std::to_string(p.columns) + " numbers each" : "";
  if (least == most) return std::to_string(least) + noun + of;
  if (p.max_count == UINT32_MAX) return std::to_string(least) + noun + " or more" + of;
  return std::to_string(least) + " to " + std::to_string(most) + noun + of;
}

std::string defaultText(const host::ParamInfo& p) {
  const auto choice = static_cast<size_t>(std::max(p.def, 0.0));
  switch (p.kind) {
    case HSP_REAL:
    case HSP_INT:
      return document::numberText(p.def);
    case HSP_BOOL:
      return p.def != 0 ? "true" : "false";
    case HSP_ENUM:
      return choice < p.choices.size() ? p.choices[choice] : "";
    default:
      return p.def_text.value_or("");
  }
}

/// Returns the value that a file gives for the parameter, as text.
std::string valueText(const host::ParamInfo& p, const scene::Value& value) {
  if (p.kind == HSP_REAL || p.kind == HSP_INT) return document::numberText(value.number);
  if (p.kind == HSP_BOOL) return value.number != 0 ? "true" : "false";
  if (p.kind == HSP_ENUM) {
    const auto choice = static_cast<size_t>(std::max(value.number, 0.0));
    return choice < p.choices.size() ? p.choices[choice] : "";
  }
  if (p.kind != HSP_ARRAY) return value.text;
  constexpr size_t kShown = 12;
  std::string text = "[";
  for (size_t i = 0; i < std::min(kShown, value.numbers.size()); ++i)
    text += (i > 0 ? ", " : "") + document::numberText(value.numbers[i]);
  return text + (value.numbers.size() > kShown ? ", ...]" : "]");
}

void printParam(const host::ParamInfo& p, const scene::Value* value) {
  std::string facts = p.kind == HSP_ARRAY ? "list of " + countText(p) : typeText(p);
  const bool ranged = p.kind == HSP_REAL || p.kind == HSP_INT || p.kind == HSP_ARRAY;
  if (ranged) facts += ", " + document::expectedOf({p.min, p.max, p.unit.c_str()});
  const bool is_required = (p.flags & HSP_P_REQUIRED) != 0;
  const std::string def = defaultText(p);
  facts += is_required ? "; required" : def.empty() ? "" : "; default " + def;
  if (value != nullptr && p.kind != HSP_DATA) facts += "; in this file " + valueText(p, *value);
  if ((p.flags & HSP_P_LIVE) != 0) facts += "; may change while running";
  if ((p.flags & HSP_P_LIVE) != 0 && (p.flags & HSP_P_SAFETY) != 0) facts += " with consent (ctl set --consent)";
  if ((p.flags & HSP_P_ACCURACY) != 0) facts += "; trades speed for accuracy";
  std::printf("  %-20s %s\n  %-20s %s\n", p.id.c_str(), facts.c_str(), "", p.doc.c_str());
}

Json paramJson(const host::ParamInfo& p) {
  Json json{{"id", p.id}, {"type", typeText(p)}, {"unit", p.unit}, {"doc", p.doc}};
  const bool ranged = p.kind == HSP_REAL || p.kind == HSP_INT || p.kind == HSP_ARRAY;
  if (ranged && std::isfinite(p.min)) json["min"] = p.min;
  if (ranged && std::isfinite(p.max)) json["max"] = p.max;
  if (p.kind == HSP_ENUM) json["choices"] = p.choices;
  if (p.kind == HSP_REAL || p.kind == HSP_INT) json["default"] = p.def;
  if (p.kind == HSP_BOOL) json["default"] = p.def != 0;
  if (p.kind > HSP_INT && p.kind != HSP_BOOL) json["default"] = defaultText(p);
  json["required"] = (p.flags & HSP_P_REQUIRED) != 0;
  json["live"] = (p.flags & HSP_P_LIVE) != 0;
  return json;
}

/// Returns the file that is used for the name of a class in its place; "" if the class itself is used. The catalogue
/// decides, because NAME.so comes before a file of another name in an earlier folder.
std::string hidingFile(const host::ClassInfo& info) {
  const auto used = info.kind == host::Kind::kShape ? catalog().shape(info.name) : catalog().device(info.name);
  return !used || (*used)->file == info.file ? "" : (*used)->file.string();
}

}  // namespace

nlohmann::ordered_json classJson(const host::ClassInfo& info) {
  auto params = Json::array();
  for (const host::ParamInfo& p : info.params) params.push_back(paramJson(p));
  return {{"name", info.name},
          {"id", info.id},
          {"version", info.version},
          {"licence", info.license},
          {"doc", info.doc},
          {"file", info.file.string()},
          {"moves", (info.flags & HSP_C_MOVES) != 0},
          {"deforms", (info.flags & HSP_C_DEFORMS) != 0},
          {"parameters", params}};
}

nlohmann::ordered_json classesJson(const std::vector<const host::CatalogFile*>& files, host::Kind kind) {
  auto plugins = Json::array(), unusable = Json::array();
  for (const host::CatalogFile* file : files) {
    if (!file->error.empty()) unusable.push_back(file->error);
    for (const host::ClassInfo& info : file->classes) {
      if (info.kind != kind) continue;
      const std::string winner = hidingFile(info);
      plugins.push_back(classJson(info));
      plugins.back()["hidden_by"] = winner.empty() ? Json() : Json(winner);
    }
  }
  return {{"plugins", plugins}, {"unusable", unusable}};
}

void printClasses(const std::vector<const host::CatalogFile*>& files, host::Kind kind, bool details,
                  const std::map<std::string, std::string>& notes) {
  for (const host::CatalogFile* file : files) {
    for (const host::ClassInfo& info : file->classes) {
      if (info.kind != kind) continue;
      const std::string winner = hidingFile(info);
      const std::string note = winner.empty() ? "" : " (hidden by " + winner + ")";
      std::printf("%-18s %-8s %s%s\n", info.name.c_str(), info.version.c_str(), info.doc.c_str(), note.c_str());
      if (const auto more = notes.find(info.name); more != notes.end())
        std::printf("%-18s %-8s %s\n", "", "", more->second.c_str());
      if (details)
        std::printf("%-18s %-8s %s, %s, %s\n", "", "", info.id.c_str(), info.license.c_str(), file->path.c_str());
    }
  }
}

void warnOfAbsentFolders() {
  const char* listed = std::getenv("HAPTICD_PLUGIN_PATH");
  std::stringstream dirs(listed != nullptr ? listed : "");
  std::error_code error;
  for (std::string dir; std::getline(dirs, dir, ':');)
    if (!dir.empty() && !std::filesystem::is_directory(dir, error))
      std::fprintf(stderr, "warning: HAPTICD_PLUGIN_PATH names %s, but there is no such folder\n", dir.c_str());
}

void printUnusable(const std::vector<const host::CatalogFile*>& files) {
  for (const host::CatalogFile* file : files)
    if (!file->error.empty()) std::printf("not usable: %s\n", file->error.c_str());
}

void printClass(const host::ClassInfo& info, const std::vector<scene::Value>& values) {
  std::printf("%s %s (%s)\n%s\n\n", info.name.c_str(), info.version.c_str(), info.id.c_str(), info.doc.c_str());
  std::printf("  file     %s\n  licence  %s\n  ABI      %u.%u\n", info.file.c_str(), info.license.c_str(),
              HSP_ABI_MAJOR, info.abi_minor);
  if (info.kind == host::Kind::kShape)
    std::printf("  moves    %s\n  deforms  %s\n", (info.flags & HSP_C_MOVES) != 0 ? "may" : "no",
                (info.flags & HSP_C_DEFORMS) != 0 ? "may" : "no");
  std::printf("\nparameters%s\n", info.params.empty() ? ": none" : "");
  for (const host::ParamInfo& param : info.params) printParam(param, givenIn(values, param.id));
}

std::string searchedText(const std::vector<std::filesystem::path>& dirs) {
  std::string text = "  searched:";
  for (const auto& dir : dirs) text += "\n    " + dir.string();
  return text + "\n  fix: build or install one, or add its folder to HAPTICD_PLUGIN_PATH";
}

}  // namespace hapticd::cli
