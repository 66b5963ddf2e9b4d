// SPDX-License-Identifier: MIT
#include "cli/plugin/file.hpp"

#include <filesystem>

#include "cli/support/command.hpp"
#include "cli/support/shared_object.hpp"

namespace hapticd::cli {
namespace {

namespace fs = std::filesystem;

/// Returns the shared objects in a folder and its folder build; "" if there is none.
std::string objectsIn(const fs::path& folder) {
  std::string found;
  std::error_code error;
  for (const fs::path& dir : {folder, folder / "build"})
    for (const auto& entry : fs::directory_iterator(dir, error))
      if (entry.path().extension() == ".so") found += (found.empty() ? "" : " or ") + entry.path().string();
  return found;
}

}  // namespace

std::string whyNoPlugin(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    const std::string objects = objectsIn(path);
    return path + " is a folder, expected the file of a plugin" +
           (objects.empty() ? " (FILE.so); build it first, as the README of the folder says" : ": " + objects);
  }
  if (!fs::exists(path, error)) {
    const auto named = catalog().shape(path);
    return "there is no file \"" + path + "\", expected the file of a plugin" +
           (named ? "; the file of the plugin with this name is " + (*named)->file.string() : " (FILE.so)");
  }
  if (isSharedObject(path)) return "";
  return path +
         " is not a plugin, expected a shared object (FILE.so); "
         "a scene or a device file is checked with: hapticd check FILE";
}

}  // namespace hapticd::cli
