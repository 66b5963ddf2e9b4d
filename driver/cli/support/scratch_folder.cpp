// SPDX-License-Identifier: MIT
#include "cli/support/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace hapticd::cli {

namespace fs = std::filesystem;

Result<ScratchFolder> ScratchFolder::make(const std::string& name) {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  if (error) return Error{"TMPDIR: " + error.message() + "; expected a folder that can be written"};
  std::string path = (parent / ("hapticd-" + name + "-XXXXXX")).string();
  if (mkdtemp(path.data()) == nullptr) return Error{path + ": cannot be created: " + std::strerror(errno)};
  return ScratchFolder(path);
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  if (!path_.empty()) fs::remove_all(path_, error);
}

}  // namespace hapticd::cli
