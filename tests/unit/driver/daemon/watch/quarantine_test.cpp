// SPDX-License-Identifier: MIT
#include "watch/quarantine.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace hapticd::watch {
namespace {

TEST(Quarantine, RemembersEachPluginOnceAndForgetsItOnOrder) {
  const auto dir = std::filesystem::temp_directory_path() / ("quarantine" + std::to_string(getpid()));
  std::filesystem::create_directories(dir);
  EXPECT_TRUE(quarantined(dir).empty());
  std::ofstream(dir / kQuarantineFile) << "a\tSIGSEGV\nb\tSIGFPE\na\tagain\n\n";
  ASSERT_EQ(quarantined(dir).size(), 2u);
  EXPECT_EQ(quarantined(dir)[0].reason, "SIGSEGV");
  EXPECT_TRUE(*clearQuarantine(dir, "a"));
  EXPECT_FALSE(*clearQuarantine(dir, "a"));
  ASSERT_EQ(quarantined(dir).size(), 1u);
  EXPECT_EQ(quarantined(dir)[0].plugin, "b");
  std::filesystem::remove_all(dir);
}

TEST(Quarantine, HoldsAFileAndNotEveryOneOfItsName) {
  const auto dir = std::filesystem::temp_directory_path() / ("quarantine-files" + std::to_string(getpid()));
  std::filesystem::create_directories(dir);
  std::ofstream(dir / kQuarantineFile)
      << "a\tSIGSEGV\t8 bytes of 1.2 /x/a.so\na\tSIGFPE\t9 bytes of 3.4 /x/a.so\nb\tSIGBUS\n";
  const auto list = quarantined(dir);
  ASSERT_EQ(list.size(), 3u);
  EXPECT_TRUE(list[0].holds("a", "8 bytes of 1.2 /x/a.so"));
  EXPECT_FALSE(list[0].holds("a", "9 bytes of 3.4 /x/a.so"));
  EXPECT_FALSE(list[0].holds("b", "8 bytes of 1.2 /x/a.so"));
  EXPECT_EQ(list[0].fileForPeople(), "/x/a.so of 1970-01-01 00:00:01 UTC, 8 bytes");
  EXPECT_EQ(list[2].fileForPeople(), "");
  EXPECT_TRUE(list[2].holds("b", "whatever the file is: an older version wrote no more"));
  EXPECT_TRUE(*clearQuarantine(dir, "b"));
  ASSERT_EQ(quarantined(dir).size(), 2u);
  EXPECT_EQ(quarantined(dir)[1].file, "9 bytes of 3.4 /x/a.so");
  EXPECT_TRUE(*clearQuarantine(dir, "a"));
  EXPECT_TRUE(quarantined(dir).empty());
  std::filesystem::remove_all(dir);
}

}  // namespace
}  // namespace hapticd::watch
