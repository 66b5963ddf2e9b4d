// SPDX-License-Identifier: MIT
/// Plugins and device modules that are linked into this program instead of being loaded, for platforms without
/// dlopen(). Each has an entry with its own name: hsp_entry_NAME or hdv_entry_NAME. The CMake function
/// hapticd_link_modules() of HapticdPlugin.cmake compiles them in this way, and makes the list of those that a program
/// contains.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "description/class_info.hpp"
#include "hapticd/device.h"
#include "hapticd/shape.h"

namespace hapticd::host {

/// One built-in plugin or module. In its description, the path is kBuiltInFolder/NAME instead of a file.
struct BuiltIn {
  std::string name;
  const hsp_entry* shapes = nullptr;
  const hdv_entry* devices = nullptr;
};

constexpr const char* kBuiltInFolder = "(built in)";

/// [main] Sets the list of the plugins and modules that this program contains. Call it before the first scene is read.
/// The list must outlive every instance.
void setBuiltIns(std::span<const BuiltIn> list);

/// [main] Sets the list that hapticd_link_modules() made for this program. Only programs with such a list can call it.
void takeBuiltIns();

/// [any] Returns the built-in plugin or module with that path; nullptr if there is none.
const BuiltIn* findBuiltIn(const std::filesystem::path& path);

/// [any] Returns the paths of all built-in plugins or modules with classes of a kind.
std::vector<std::filesystem::path> builtIns(Kind kind);

}  // namespace hapticd::host
