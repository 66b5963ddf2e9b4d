// SPDX-License-Identifier: MIT
/// A loaded shared object. A process loads each file only once. The code stays in memory until the process ends. A
/// plugin may have started a thread, and the process would crash if such a thread returned to code that was unloaded.
#pragma once
#include <filesystem>
#include <memory>

#include "base/result.hpp"
#include "hapticd/device.h"
#include "hapticd/shape.h"

namespace hapticd::host {

class Library {
 public:
  /// [main] Loads `file` (RTLD_NOW | RTLD_LOCAL). The error contains the message of the system's loader.
  static Result<std::shared_ptr<Library>> open(const std::filesystem::path& file);
  /// [any] Returns the library of `file`; nullptr if it is not loaded now.
  static std::shared_ptr<Library> loaded(const std::filesystem::path& file);
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// [main] Returns the entry of a shape plugin or a device module. The magic number and the major version are checked.
  Result<const hsp_entry*> shapes() const;
  Result<const hdv_entry*> devices() const;
  bool exports(const char* symbol) const;  ///< [main]
  const std::filesystem::path& file() const { return file_; }

 private:
  Library(std::filesystem::path file, void* handle) : file_(std::move(file)), handle_(handle) {}
  std::filesystem::path file_;
  void* handle_;
};

}  // namespace hapticd::host
