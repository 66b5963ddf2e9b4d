// SPDX-License-Identifier: MIT
#include "record/dump_folder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace hapticd::record {
namespace {

namespace fs = std::filesystem;
constexpr std::time_t kNoon = 1'795'262'400;  ///< 2026-11-21 12:00:00 UTC

class DumpFolder : public testing::Test {
 protected:
  ~DumpFolder() override { fs::remove_all(folder_); }
  std::string write(std::time_t when) const {
    const std::string file = nextDump(folder_, when);
    std::ofstream(file) << "dump";
    return file;
  }
  void put(const std::string& name) const {
    fs::create_directories(folder_);
    std::ofstream(folder_ + "/" + name) << "mine";
  }
  size_t files() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  std::string folder_ = (fs::temp_directory_path() / ("hapticd-dumps-" + std::to_string(getpid()))).string();
};

TEST_F(DumpFolder, NamesADumpByItsTime) {
  EXPECT_EQ(write(kNoon), folder_ + "/blackbox-20261121T120000Z.h5");
}

TEST_F(DumpFolder, NeverNamesAFileThatIsThere) {
  write(kNoon);
  EXPECT_EQ(write(kNoon), folder_ + "/blackbox-20261121T120000Z-1.h5");
}

TEST_F(DumpFolder, KeepsTheNewest) {
  std::vector<std::string> written;
  for (int i = 0; i < 3 * static_cast<int>(kKeptDumps); ++i) written.push_back(write(kNoon + i));
  EXPECT_EQ(files(), kKeptDumps);
  for (size_t i = 0; i < kKeptDumps; ++i) EXPECT_TRUE(fs::exists(written[written.size() - 1 - i])) << i;
}

TEST_F(DumpFolder, LeavesWhatIsNoDumpOfAFault) {
  const std::vector<std::string> others{"blackbox-hapticd-crash-0.h5", "blackbox-20261121T120000Z.csv", "notes.h5",
                                        "blackbox-2026112xT120000Z.h5"};
  for (const std::string& name : others) put(name);
  for (int i = 0; i < 2 * static_cast<int>(kKeptDumps); ++i) write(kNoon + i);
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(folder_ + "/" + name)) << name;
}

}  // namespace
}  // namespace hapticd::record
