// SPDX-License-Identifier: MIT
/// A loaded shared object. The same file is loaded once a process. Its code stays in memory to the end of the process:
/// a plugin may have begun a thread, and one that returns into code that is gone ends the daemon.
#pragma once
#include <filesystem>
#include <memory>

#include "base/result.hpp"
#include "hapticd/device.h"
#include "hapticd/shape.h"

namespace hapticd::host {

class Library {
 public:
  /// [main] Loads `file` (RTLD_NOW | RTLD_LOCAL). The message has the loader's own reason.
  static Result<std::shared_ptr<Library>> open(const std::filesystem::path& file);
  /// [any] The library of `file` if it is loaded now; nullptr if it is not.
  static std::shared_ptr<Library> loaded(const std::filesystem::path& file);
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// [main] The entry of a shape plugin or device module, checked for magic and major version.
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
