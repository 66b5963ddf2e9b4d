// SPDX-License-Identifier: MIT
/// Plugins and modules on the terminal.
#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::cli {

/// One line a class: name, version, first sentence. @param details file and licence below it
/// @param notes what else is to be said of a name, behind its line
void printClasses(const std::vector<const host::CatalogFile*>& files, host::Kind kind, bool details,
                  const std::map<std::string, std::string>& notes = {});

/// The same facts for programs: {"plugins": [...], "unusable": [...]}, with the parameters of each.
nlohmann::ordered_json classesJson(const std::vector<const host::CatalogFile*>& files, host::Kind kind);
nlohmann::ordered_json classJson(const host::ClassInfo& info);

/// Files that could not be described, with the reason.
void printUnusable(const std::vector<const host::CatalogFile*>& files);

/// Documentation of one class from its parameter table.
/// @param values of the file, which stand beside the defaults
void printClass(const host::ClassInfo& info, const std::vector<scene::Value>& values = {});

/// " searched:" and one folder per line.
std::string searchedText(const std::vector<std::filesystem::path>& dirs);

}  // namespace hapticd::cli
