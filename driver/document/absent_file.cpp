// SPDX-License-Identifier: MIT
#include "document/absent_file.hpp"

#include <vector>

#include "base/passed_files.hpp"
#include "document/suggestion.hpp"

namespace hapticd::document {

namespace fs = std::filesystem;

std::string neighbourMeant(const fs::path& absent, const fs::path& own) {
  std::vector<std::string> neighbours;
  std::error_code error;
  const fs::path folder = absent.has_parent_path() ? absent.parent_path() : ".";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().filename() != own.filename() && entry->exists(error))
      neighbours.push_back(entry->path().filename().string());
  return suggestion(absent.filename().string(), neighbours);
}

std::string withAbsentFiles(std::string answer, const fs::path& own) {
  const std::string told = std::string(" ") + kNotPassed;
  for (size_t at = answer.find(told); at != std::string::npos; at = answer.find(told, at + 1)) {
    const size_t before = answer.rfind(": /", at);  // a path follows the key
    const size_t first = before == std::string::npos ? 0 : before + 2;
    const std::string path = answer.substr(first, at - first);
    std::error_code error;
    if (path.empty() || path.front() != '/' || fs::exists(fs::path(path), error) || error) continue;
    const std::string text = "there is no file " + path + ", expected the path of a file" + neighbourMeant(path, own);
    answer.replace(first, at + told.size() - first, text);
    at = first;
  }
  return answer;
}

}  // namespace hapticd::document
