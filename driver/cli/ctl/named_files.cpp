// SPDX-License-Identifier: MIT
#include "cli/ctl/named_files.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <set>

#include "base/passed_files.hpp"
#include "document/node.hpp"

namespace hapticd::cli {

namespace {

namespace fs = std::filesystem;
using document::Node;

bool isFile(const std::string& file) {
  struct stat info{};
  return stat(file.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

class Collector {
 public:
  Result<NamedFiles> collect(const std::string& scene) {
    if (auto done = open(scene); !done) return Error{done.error()};
    document::Problems problems;  // not reported here, because the daemon reports them
    const auto root = document::parseFile(scene, problems);
    if (!root) return std::move(files_);
    if (auto done = values(*root, fs::path(scene).parent_path()); !done) return Error{done.error()};
    for (const char* key : {"device", "devices"})
      if (const Node* devices = root->find(key))
        if (auto done = deviceFiles(*devices, fs::path(scene).parent_path()); !done) return Error{done.error()};
    return std::move(files_);
  }

 private:
  static std::string pathOf(const Node& node, const fs::path& folder) {
    constexpr size_t kLongest = 4096;
    if (!node.isScalar() || node.scalar.empty() || node.scalar.size() > kLongest) return "";
    if (!node.quoted && document::toNumber(node.scalar)) return "";
    const std::string file = (folder / node.scalar).lexically_normal().string();
    return isFile(file) ? file : "";
  }

  Result<void> open(const std::string& file) {
    if (!known_.insert(file).second) return {};
    auto opened = openToPass(file);
    if (!opened) return Error{file + ": " + opened.error()};
    if (files_.names.size() == kMostDescriptors)
      return Error{files_.names.front() + ": names more than " + std::to_string(kMostDescriptors) +
                   " files, expected fewer in one request\n  fix: add its models from several scenes"};
    files_.names.push_back(file);
    files_.descriptors.push_back(std::move(*opened));
    return {};
  }

  Result<void> values(const Node& node, const fs::path& folder) {
    if (const std::string file = pathOf(node, folder); !file.empty())
      if (auto done = open(file); !done) return done;
    for (const Node& item : node.items)
      if (auto done = values(item, folder); !done) return done;
    for (const document::Entry& entry : node.entries)
      if (auto done = values(entry.value, folder); !done) return done;
    return {};
  }

  /// Adds the files that these device files name.
  Result<void> deviceFiles(const Node& node, const fs::path& folder) {
    for (const Node& item : node.items)
      if (auto done = deviceFiles(item, folder); !done) return done;
    const Node* named = node.isMap() ? node.find("file") : &node;
    const std::string file = named != nullptr ? pathOf(*named, folder) : "";
    if (file.empty()) return {};
    document::Problems problems;
    const auto root = document::parseFile(file, problems);
    return root ? values(*root, fs::path(file).parent_path()) : Result<void>();
  }

  NamedFiles files_;
  std::set<std::string> known_;
};

}  // namespace

std::vector<int> NamedFiles::numbers() const {
  std::vector<int> numbers;
  for (const Descriptor& file : descriptors) numbers.push_back(file.get());
  return numbers;
}

Result<NamedFiles> openNamed(const std::string& scene) {
  return Collector().collect(scene);
}

}  // namespace hapticd::cli
