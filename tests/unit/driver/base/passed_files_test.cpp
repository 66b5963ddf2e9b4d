// SPDX-License-Identifier: MIT
#include "base/passed_files.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "base/regular_file.hpp"

namespace hapticd {
namespace {

std::string written(const char* name, const std::string& text) {
  const std::string file = testing::TempDir() + name + std::to_string(getpid());
  std::ofstream(file) << text;
  return file;
}

Descriptor opened(const std::string& file, int flags = O_RDONLY) {
  return Descriptor(open(file.c_str(), flags | O_CLOEXEC));
}

Result<PassedFiles> passing(const std::string& name, Descriptor file) {
  std::vector<Descriptor> files;
  files.push_back(std::move(file));
  return PassedFiles::copy({name}, std::move(files));
}

std::string read(const std::string& file) {
  const auto text = readRegular(file, 1000);
  return text ? *text : "error: " + text.error();
}

TEST(PassedFiles, AreReadUnderNamesThatNeedNotExistHere) {
  const std::string file = written("passed", "what it says");
  const auto files = passing("/nowhere/a.yaml", opened(file));
  ASSERT_TRUE(files) << files.error();
  std::ofstream(file) << "something else";
  const PassedFiles::Scope scope(*files);
  EXPECT_EQ(read("/nowhere/a.yaml"), "what it says") << "a copy, which nobody changes under the reader";
  std::ifstream plugin(files->pathOf("/nowhere/a.yaml"));
  std::ostringstream text;
  text << plugin.rdbuf();
  EXPECT_EQ(text.str(), "what it says");
  unlink(file.c_str());
}

TEST(PassedFiles, KeepAllOtherNamesClosedWhileTheyAreInForce) {
  const std::string secret = written("secret", "a secret");
  auto files = passing("/a", Descriptor(memfd_create("a", MFD_CLOEXEC)));
  ASSERT_TRUE(files);
  {
    const PassedFiles::Scope scope(*files);
    EXPECT_NE(read(secret).find("was not passed along"), std::string::npos);
    EXPECT_NE(read("/etc/passwd").find("was not passed along"), std::string::npos);
  }
  EXPECT_EQ(read(secret), "a secret");
  files->allow(secret);
  const PassedFiles::Scope scope(*files);
  EXPECT_EQ(read(secret), "a secret");
  unlink(secret.c_str());
}

TEST(PassedFiles, AreReadWithTheRightsOfTheDescriptor) {
  const std::string file = written("rights", "a secret");
  for (const int flags : {O_PATH, O_WRONLY}) {
    const auto files = passing("/a", opened(file, flags));
    ASSERT_FALSE(files) << flags;
    EXPECT_EQ(files.error().find("a secret"), std::string::npos);
  }
  unlink(file.c_str());
}

TEST(PassedFiles, AreNothingThatMayLetAReaderWaitOrAnswersWhoReads) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  const Descriptor writer(ends[1]);
  const auto pipe = passing("/pipe", Descriptor(ends[0]));
  ASSERT_FALSE(pipe);
  EXPECT_NE(pipe.error().find("is a pipe, expected a file"), std::string::npos) << pipe.error();
  EXPECT_FALSE(passing("/device", opened("/dev/zero")));
  EXPECT_FALSE(passing("/folder", opened("/", O_DIRECTORY)));
  EXPECT_FALSE(passing("/status", opened("/proc/self/status")));
  const auto copy = openToPass("/proc/self/status");
  ASSERT_TRUE(copy) << copy.error();
  EXPECT_TRUE(passing("/status", Descriptor(dup(copy->get())))) << "a copy of the asking program's own is plain memory";
}

TEST(PassedFiles, AreBounded) {
  Descriptor large(memfd_create("large", MFD_CLOEXEC));
  ASSERT_EQ(ftruncate(large.get(), static_cast<off_t>(PassedFiles::kMostBytes) + 1), 0);
  const auto files = passing("/large", std::move(large));
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().find("too large"), std::string::npos);
  EXPECT_FALSE(PassedFiles::copy({"/a", "/b"}, {})) << "a descriptor for each name";
}

TEST(PassedFiles, AreToldByTheNamesThatOthersKnow) {
  const auto files = passing("/home/me/a.yaml", Descriptor(memfd_create("a", MFD_CLOEXEC)));
  ASSERT_TRUE(files);
  const std::string path = files->pathOf("/home/me/a.yaml");
  EXPECT_EQ(files->named(path + ":3:1: wrong, see " + path), "/home/me/a.yaml:3:1: wrong, see /home/me/a.yaml");
  EXPECT_EQ(files->named(path + "0:3"), path + "0:3") << "another descriptor";
}

}  // namespace
}  // namespace hapticd
