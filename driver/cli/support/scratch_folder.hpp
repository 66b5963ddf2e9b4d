// SPDX-License-Identifier: MIT
/// A folder for the files of one command, which is removed at the end.
#pragma once
#include <string>
#include <utility>

#include "base/result.hpp"

namespace hapticd::cli {

class ScratchFolder {
 public:
  ScratchFolder() = default;
  ~ScratchFolder();
  ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  ScratchFolder& operator=(ScratchFolder&& other) noexcept { return std::swap(path_, other.path_), *this; }

  /// [main] Makes the folder `hapticd-NAME-...` among the temporary files. Only this user can open it.
  static Result<ScratchFolder> make(const std::string& name);
  const std::string& path() const { return path_; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace hapticd::cli
