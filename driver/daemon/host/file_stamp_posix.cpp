// SPDX-License-Identifier: MIT
#include <sys/stat.h>

#include "host/file_stamp.hpp"

namespace hapticd::host {

std::optional<FileStamp> stampOf(const std::filesystem::path& file) {
  struct stat about{};
  if (stat(file.c_str(), &about) != 0) return std::nullopt;
  return FileStamp{static_cast<int64_t>(about.st_dev), static_cast<int64_t>(about.st_ino), about.st_size,
                   about.st_mtim.tv_sec, about.st_mtim.tv_nsec};
}

}  // namespace hapticd::host
