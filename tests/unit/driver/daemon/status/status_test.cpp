// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "status/page_file.hpp"

namespace hapticd::status {
namespace {

std::string temporary(const char* name) {
  return testing::TempDir() + name + std::to_string(getpid());
}

struct Pair {
  uint64_t a = 0, b = 0, c = 0, d = 0;
};

TEST(Slot, NeverGivesHalfARecord) {
  Slot<Pair> slot;
  std::atomic<bool> stop{false};
  std::thread writer([&] {
    for (uint64_t i = 1; !stop; ++i) {
      slot.write({i, 2 * i, 3 * i, ~i});
      if (i % 64 == 0) std::this_thread::yield();
    }
  });
  uint64_t last = 0;
  for (int i = 0; i < 100000; ++i) {
    const auto pair = slot.read();
    if (!pair || pair->a == 0) continue;
    ASSERT_EQ(pair->b, 2 * pair->a);
    ASSERT_EQ(pair->c, 3 * pair->a);
    ASSERT_EQ(pair->d, ~pair->a);
    ASSERT_GE(pair->a, last);
    last = pair->a;
  }
  stop = true;
  writer.join();
  EXPECT_EQ(slot.read()->b, 2 * slot.read()->a);
}

TEST(SharedHistogram, HasTheQuantilesOfTheOneThatReportsUse) {
  SharedHistogram shared;
  record::Histogram plain;
  for (int i = 1; i <= 5000; ++i) {
    shared.add(0.01 * i * i);
    plain.add(0.01 * i * i);
  }
  for (const double q : {0.0, 0.5, 0.9, 0.99, 0.999}) EXPECT_EQ(shared.quantile(q), plain.quantile(q)) << q;
  EXPECT_EQ(shared.max(), plain.max());
}

TEST(PageFile, IsReadByOthersAndGoneWithItsOwner) {
  const std::string file = temporary("page");
  auto owner = PageFile::create(file);
  ASSERT_TRUE(owner) << owner.error();
  EXPECT_FALSE(PageFile::open(file)) << "not yet shown";
  (*owner)->page().now.write({7, 1, 2, 0.5});
  (*owner)->page().magic = kPageMagic;
  auto reader = PageFile::open(file);
  ASSERT_TRUE(reader) << reader.error();
  EXPECT_EQ(std::as_const(**reader).page().now.read()->tick, 7u);
  (*owner)->page().now.write({8, 1, 2, 0.5});
  EXPECT_EQ(std::as_const(**reader).page().now.read()->tick, 8u);
  *owner = nullptr;
  EXPECT_FALSE(PageFile::open(file));
  EXPECT_EQ(std::as_const(**reader).page().now.read()->tick, 8u) << "a reader keeps what it has mapped";
}

TEST(RuntimeFolder, IsInMemoryWhereverTheSessionKeepsItsFiles) {
  const std::string session = testing::TempDir() + "hapticd-session-" + std::to_string(getpid());
  std::filesystem::create_directory(session);
  unsetenv("RUNTIME_DIRECTORY");
  setenv("XDG_RUNTIME_DIR", session.c_str(), 1);
  const std::string made = runtimeFolder(true);
  struct statfs info{};
  ASSERT_EQ(statfs(made.c_str(), &info), 0) << made;
  EXPECT_EQ(info.f_type, TMPFS_MAGIC) << made << ": the servo would wait for a disk";
  EXPECT_EQ(runtimeFolder(false), made) << "others look elsewhere";
  unsetenv("XDG_RUNTIME_DIR");
  std::filesystem::remove_all(session);
}

TEST(RuntimeFolder, OfADaemonOfTheSystemIsFoundBesideOnesOwnFolder) {
  const std::string base = "/dev/shm/hapticd-status-test-" + std::to_string(getpid());
  const std::string own = base + "/session/hapticd", system = base + "/system";
  std::filesystem::create_directories(own);
  std::filesystem::create_directories(system);
  unsetenv("RUNTIME_DIRECTORY");
  setenv("XDG_RUNTIME_DIR", (base + "/session").c_str(), 1);
  const auto run = [](const std::string& folder) { std::ofstream(folder + "/arm.sock") << ""; };
  EXPECT_EQ(runtimeFolderOf("arm", system), own) << "none runs";
  run(system);
  EXPECT_EQ(runtimeFolderOf("arm", system), system);
  EXPECT_EQ(runtimeFolderOf("other", system), own);
  run(own);
  EXPECT_EQ(runtimeFolderOf("arm", system), own) << "one's own comes first";
  unsetenv("XDG_RUNTIME_DIR");
  std::filesystem::remove_all(base);
}

TEST(PageFile, RefusesWhatIsNoPage) {
  EXPECT_FALSE(PageFile::open("/dev/null"));
  EXPECT_FALSE(PageFile::open(temporary("none")));
}

TEST(PageFile, CannotBeWrittenByAReaderAndOutlivesItsDeath) {
  const std::string file = temporary("killed");
  auto owner = PageFile::create(file);
  (*owner)->page().magic = kPageMagic;
  const pid_t child = fork();
  if (child == 0) {
    auto reader = PageFile::open(file);
    signal(SIGSEGV, SIG_DFL);
    const_cast<Page&>(std::as_const(**reader).page()).pid = 1;  // mapped read-only: the reader dies, not the page
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ((*owner)->page().pid, static_cast<uint32_t>(getpid()));
}

}  // namespace
}  // namespace hapticd::status
