// SPDX-License-Identifier: MIT
/// Plugins and device modules that are linked into this program instead of being loaded, for platforms without
/// dlopen(). Each has an entry of its own name: hsp_entry_NAME or hdv_entry_NAME. hapticd_link_modules() of
/// HapticdPlugin.cmake compiles them so and makes the program's list.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "description/class_info.hpp"
#include "hapticd/device.h"
#include "hapticd/shape.h"

namespace hapticd::host {

/// One of them. Its description has the path kBuiltInFolder/NAME, where a loaded one has its file.
struct BuiltIn {
  std::string name;
  const hsp_entry* shapes = nullptr;
  const hdv_entry* devices = nullptr;
};

constexpr const char* kBuiltInFolder = "(built in)";

/// [main] Called before the first scene is read: says what this program contains. The list outlives every instance.
void setBuiltIns(std::span<const BuiltIn> list);

/// [main] The same with the list that hapticd_link_modules() made for this program. Other programs have no such list.
void takeBuiltIns();

/// [any] The built-in plugin or module of that path; nullptr if there is none.
const BuiltIn* findBuiltIn(const std::filesystem::path& path);

/// [any] Paths of all built-in files that hold classes of a kind.
std::vector<std::filesystem::path> builtIns(Kind kind);

}  // namespace hapticd::host
