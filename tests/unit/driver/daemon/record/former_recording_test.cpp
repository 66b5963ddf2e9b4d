// SPDX-License-Identifier: MIT
/// A recording whose name is in use: by a former recording, or by other programs while it is written.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "record/recording.hpp"
#include "record/recording_file.hpp"

namespace hapticd::record {
namespace {

class FormerRecording : public testing::Test {
 protected:
  FormerRecording() {
    StreamSpec ticks;
    ticks.name = "ticks";
    ticks.layout.add("tick", ColumnType::kCount, "", "number");
    ticks.ring_rows = 100;
    streams_ = {ticks};
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~FormerRecording() override { std::filesystem::remove_all(folder_); }

  std::unique_ptr<RecordingFile> create() {
    auto file =
        RecordingFile::create(name_, streams_, {"{\"columns\": " + columnsJson(streams_) + "}", "hapticd: 1\n"});
    EXPECT_TRUE(file) << (file ? "" : file.error());
    return file ? std::move(*file) : nullptr;
  }
  /// Writes rows, and returns the error of their publish(), or "".
  static std::string write(RecordingFile& file, uint64_t rows) {
    for (uint64_t tick = 0; tick < rows; ++tick)
      if (auto done = file.append(0, reinterpret_cast<const std::byte*>(&tick), 1); !done) return done.error();
    const auto done = file.publish();
    return done ? "" : done.error();
  }
  void record(uint64_t rows) {
    const auto file = create();
    ASSERT_EQ(write(*file, rows), "");
    ASSERT_TRUE(file->close());
  }
  /// The rows of the recording with the name, or -1.
  int64_t rows() const {
    const auto recording = Recording::open(name_);
    return recording ? static_cast<int64_t>((*recording)->stream("ticks")->rows()) : -1;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  const std::string folder_ = testing::TempDir() + "former" + std::to_string(getpid()), name_ = folder_ + "/run.h5";
  std::vector<StreamSpec> streams_;
};

TEST_F(FormerRecording, StaysUntilTheNewOneHasRows) {
  record(50);
  create();
  EXPECT_EQ(rows(), 50);
  EXPECT_EQ(files(), 1u);
  const auto file = create();
  EXPECT_EQ(write(*file, 0), "");
  EXPECT_EQ(rows(), 50);
  EXPECT_EQ(write(*file, 10), "");
  EXPECT_EQ(rows(), 10);
  EXPECT_EQ(files(), 1u);
  EXPECT_FALSE(RecordingFile::create(name_, streams_, {})) << "two writers";
  EXPECT_TRUE(file->close());
}

TEST_F(FormerRecording, SurvivesAKillBeforeTheFirstRows) {
  record(50);
  const pid_t child = fork();
  if (child == 0) {
    const auto file = create();
    const uint64_t tick = 0;
    (void)file->append(0, reinterpret_cast<const std::byte*>(&tick), 1);
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_EQ(rows(), 50);
  record(20);
  EXPECT_EQ(rows(), 20);
  EXPECT_EQ(files(), 1u);
}

TEST_F(FormerRecording, SurvivesADiskThatIsFullBeforeTheFirstRows) {
  record(50);
  auto file = create();
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit little{std::filesystem::file_size(name_) / 64, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &little);
  const std::string error = write(*file, 10);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(error.find("the former recording of this name stays"), std::string::npos) << error;
  file.reset();
  EXPECT_EQ(rows(), 50);
  EXPECT_EQ(files(), 1u);
}

TEST_F(FormerRecording, TakesNoFileOfSomebodyElse) {
  record(50);
  std::ofstream(name_ + ".part") << "half of a download";
  record(20);
  EXPECT_EQ(rows(), 20);
  std::string text;
  std::getline(std::ifstream(name_ + ".part"), text);
  EXPECT_EQ(text, "half of a download");
}

TEST_F(FormerRecording, IsNoFileIntoWhichMessagesGo) {
  const int stdout_before = dup(STDOUT_FILENO), file = open(name_.c_str(), O_WRONLY | O_CREAT, 0644);
  dup2(file, STDOUT_FILENO);
  const auto refused = RecordingFile::create(name_, streams_, {});
  dup2(stdout_before, STDOUT_FILENO);
  close(file);
  close(stdout_before);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("messages of this run go into it"), std::string::npos) << refused.error();
}

TEST_F(FormerRecording, IsReplacedThroughALink) {
  record(50);
  std::filesystem::rename(name_, folder_ + "/other.h5");
  std::filesystem::create_symlink("other.h5", name_);
  record(20);
  EXPECT_TRUE(std::filesystem::is_symlink(name_));
  EXPECT_EQ(rows(), 20);
  EXPECT_EQ(files(), 2u);
}

TEST_F(FormerRecording, TellsThatItIsNotThereAnyMore) {
  for (const char* how : {"removed", "moved", "cut"}) {
    const auto file = create();
    ASSERT_EQ(write(*file, 10), "");
    if (how[0] == 'r') std::filesystem::remove(name_);
    if (how[0] == 'm') std::filesystem::rename(name_, folder_ + "/moved.h5");
    if (how[0] == 'c') std::filesystem::resize_file(name_, 0);
    EXPECT_EQ(write(*file, 100000), "");  // a chunk and more, so that the file is as long as before
    const auto closed = file->close();
    ASSERT_FALSE(closed) << how;
    EXPECT_NE(closed.error().find(how[0] == 'c' ? "cut this recording" : "not there any more"), std::string::npos);
  }
}

}  // namespace
}  // namespace hapticd::record
