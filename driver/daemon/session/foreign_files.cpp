// SPDX-License-Identifier: MIT
#include "session/foreign_files.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include "hapticd/abi.h"

namespace hapticd::servo {

bool isForeign(const control::Peer& peer) {
  return peer.uid != geteuid() && peer.uid != 0;
}

std::vector<std::string> filesOf(const std::vector<scene::Model>& models) {
  std::vector<std::string> files;
  for (const scene::Model& model : models)
    for (const scene::Value& value : model.parameters)
      if (value.kind == HSP_PATH && !value.text.empty()) files.push_back(value.text);
  return files;
}

Result<void> readableByAll(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    struct stat about{};
    const bool open = stat(file.c_str(), &about) == 0 && S_ISREG(about.st_mode) && (about.st_mode & S_IROTH) != 0;
    if (!open)
      return Error{file +
                   ": is not a file that every user may read, as one must be that a program of another user names\n  "
                   "fix: chmod o+r, or send the request as the user that the daemon runs as"};
  }
  return {};
}

}  // namespace hapticd::servo
