// SPDX-License-Identifier: MIT
/// Plugins and modules on the terminal.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "host/catalog.hpp"

namespace hapticd::cli {

/// One line a class: name, version, first sentence. @param details file and licence below it
void printClasses(const std::vector<const host::CatalogFile*>& files, host::Kind kind, bool details);

/// Files that could not be described, with the reason.
void printUnusable(const std::vector<const host::CatalogFile*>& files);

/// Documentation of one class from its parameter table.
void printClass(const host::ClassInfo& info);

/// "  searched:" and a folder a line.
std::string searchedText(const std::vector<std::filesystem::path>& dirs);

}  // namespace hapticd::cli
