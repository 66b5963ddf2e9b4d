// SPDX-License-Identifier: MIT
/// The log as somebody finds it in a file: levels, who spoke, JSON, rotation, and a file that cannot be written.
#include "log/log.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hapticd/abi.h"

namespace hapticd::log {
namespace {

namespace fs = std::filesystem;

class LogFile : public testing::Test {
 protected:
  LogFile() : folder_(fs::temp_directory_path() / ("hapticd-log-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~LogFile() override {
    (void)open({});
    fs::remove_all(folder_);
  }
  std::string file() const { return (folder_ / "daemon.log").string(); }
  std::vector<std::string> lines() const {
    std::ifstream in(file());
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  fs::path folder_;
};

TEST_F(LogFile, HoldsDateLevelSpeakerAndText) {
  ASSERT_TRUE(open({.level = HSP_LOG_INFO, .file = file()}));
  write(HSP_LOG_WARNING, "teapot", "answers coarser");
  ASSERT_EQ(lines().size(), 1u);
  EXPECT_NE(lines()[0].find(" warning: teapot: answers coarser"), std::string::npos) << lines()[0];
  EXPECT_EQ(lines()[0].find("20"), 0u) << "a date comes first: " << lines()[0];
}

TEST_F(LogFile, LeavesOutWhatIsBelowTheLevel) {
  ASSERT_TRUE(open({.level = HSP_LOG_WARNING, .file = file()}));
  write(HSP_LOG_DEBUG, "", "a click");
  write(HSP_LOG_INFO, "", "a model came");
  write(HSP_LOG_WARNING, "", "slow");
  write(HSP_LOG_ERROR, "", "a fault");
  ASSERT_EQ(lines().size(), 2u);
  EXPECT_NE(lines()[0].find("warning: slow"), std::string::npos);
  EXPECT_NE(lines()[1].find("error: a fault"), std::string::npos);
}

TEST_F(LogFile, IsOneJsonObjectALineWhateverTheTextHolds) {
  ASSERT_TRUE(open({.level = HSP_LOG_INFO, .file = file(), .json = true}));
  const std::string hostile = "two\nlines, \"quotes\" and \xff bytes";
  write(HSP_LOG_ERROR, "plugin", hostile);
  ASSERT_EQ(lines().size(), 1u);
  const auto line = nlohmann::json::parse(lines()[0]);
  EXPECT_EQ(line["level"], "error");
  EXPECT_EQ(line["who"], "plugin");
  EXPECT_GT(line["time"].get<double>(), 1.7e9);
  EXPECT_EQ(line["text"].get<std::string>().find("two\nlines, \"quotes\""), 0u);
}

TEST_F(LogFile, TakesALevelOutOfRangeAsTheNearest) {
  ASSERT_TRUE(open({.level = HSP_LOG_INFO, .file = file()}));
  write(-7, "", "less than debug");
  write(99, "", "more than an error");
  ASSERT_EQ(lines().size(), 1u);
  EXPECT_NE(lines()[0].find("error: more than an error"), std::string::npos);
}

TEST_F(LogFile, IsBoundedAndKeepsThreeOlderOnes) {
  ASSERT_TRUE(open({.level = HSP_LOG_INFO, .file = file()}));
  const std::string long_text(1 << 20, 'x');
  const int shown = dup(STDERR_FILENO), nowhere = ::open("/dev/null", O_WRONLY);
  dup2(nowhere, STDERR_FILENO);  // 60 MB are no use there
  for (int i = 0; i < 60; ++i) write(HSP_LOG_INFO, "", long_text);
  dup2(shown, STDERR_FILENO);
  close(shown);
  close(nowhere);
  uintmax_t bytes = 0, files = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    bytes += entry.file_size();
    ++files;
  }
  EXPECT_EQ(files, 4u);
  EXPECT_LE(bytes, 44u << 20);
}

TEST_F(LogFile, ThatCannotBeWrittenIsAnErrorWithItsName) {
  const auto opened = open({.file = "/dev/null/no/daemon.log"});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().find("/dev/null/no/daemon.log: cannot be written"), std::string::npos) << opened.error();
}

TEST(LogLevel, IsFoundByItsName) {
  EXPECT_EQ(levelOf("debug"), HSP_LOG_DEBUG);
  EXPECT_EQ(levelOf("error"), HSP_LOG_ERROR);
  EXPECT_EQ(levelOf("loud"), -1);
}

}  // namespace
}  // namespace hapticd::log
