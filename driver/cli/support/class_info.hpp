// SPDX-License-Identifier: MIT
/// Prints plugins and device modules on the terminal.
#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "host/catalog.hpp"

namespace hapticd::cli {

/// Prints one line per class: name, version, first sentence of its documentation. @param details true prints file and
/// licence below each line @param notes text to add to the line of a class, by the name of the class
void printClasses(const std::vector<const host::CatalogFile*>& files, host::Kind kind, bool details,
                  const std::map<std::string, std::string>& notes = {});

/// Returns the same facts for programs: {"plugins": [...], "unusable": [...]}, with the parameters of each class.
nlohmann::ordered_json classesJson(const std::vector<const host::CatalogFile*>& files, host::Kind kind);
nlohmann::ordered_json classJson(const host::ClassInfo& info);

/// Prints the files that could not be described, with the reason.
void printUnusable(const std::vector<const host::CatalogFile*>& files);

/// Warns of folders of HAPTICD_PLUGIN_PATH that do not exist.
void warnOfAbsentFolders();

/// Prints the documentation of one class from its parameter table. @param values values that a file gives, which are
/// printed beside the defaults
void printClass(const host::ClassInfo& info, const std::vector<scene::Value>& values = {});

/// Returns " searched:" and then one folder per line.
std::string searchedText(const std::vector<std::filesystem::path>& dirs);

}  // namespace hapticd::cli
