// SPDX-License-Identifier: MIT
#include "record/dump_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace hapticd::record {

namespace {

namespace fs = std::filesystem;

constexpr char kPrefix[] = "blackbox-", kSuffix[] = ".h5";
constexpr char kTimeForm[] = "%Y%m%dT%H%M%SZ";
constexpr size_t kTimeLength = 16;
constexpr int kMostInASecond = 100;

bool isDump(const std::string& name) {
  constexpr size_t kBegin = sizeof kPrefix - 1;
  return name.starts_with(kPrefix) && name.ends_with(kSuffix) && name.size() > kBegin + kTimeLength &&
         name[kBegin + 8] == 'T' && name[kBegin + kTimeLength - 1] == 'Z' &&
         std::all_of(name.begin() + kBegin, name.begin() + kBegin + 8, [](char c) { return c >= '0' && c <= '9'; });
}

void makeRoom(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> dumps;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (isDump(entry.path().filename().string())) dumps.push_back(entry.path().string());
  if (dumps.size() < kKeptDumps) return;
  std::sort(dumps.begin(), dumps.end());  // the names contain the time, so this sorts by time
  for (size_t i = 0; i + kKeptDumps <= dumps.size(); ++i) fs::remove(dumps[i], error);
}

}  // namespace

std::string nextDump(const std::string& folder, std::time_t now) {
  std::error_code error;
  fs::create_directories(folder, error);
  makeRoom(folder);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char stamp[kTimeLength + 1] = "";
  std::strftime(stamp, sizeof stamp, kTimeForm, &parts);
  std::string file;
  for (int i = 0; i < kMostInASecond; ++i) {
    file = folder + "/" + kPrefix + stamp + (i == 0 ? "" : "-" + std::to_string(i)) + kSuffix;
    if (!fs::exists(file, error)) break;
  }
  return file;
}

}  // namespace hapticd::record
