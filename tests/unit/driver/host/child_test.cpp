#include "host/child.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <stdexcept>

#include "host/wire.hpp"

namespace hapticd::host {
namespace {

TEST(Child, ReturnsTheBytesOfTheWorkHoweverMany) {
  const auto told = runInChild([] { return std::string(3'000'000, 'x'); }, 10'000);
  ASSERT_TRUE(told) << told.error();
  EXPECT_EQ(*told, std::string(3'000'000, 'x'));
}

TEST(Child, TellsACrashFromAHangFromAnExit) {
  const auto crash = runInChild(
      []() -> std::string {
        ::raise(SIGFPE);
        return "x";
      },
      10'000);
  ASSERT_FALSE(crash);
  EXPECT_EQ(crash.error(), "crashed: Floating point exception");
  const auto hang = runInChild(
      []() -> std::string {
        for (;;) ::pause();
      },
      100);
  ASSERT_FALSE(hang);
  EXPECT_EQ(hang.error(), "took longer than 0.10 s");
  const auto exits = runInChild([]() -> std::string { ::_exit(3); }, 10'000);
  ASSERT_FALSE(exits);
  EXPECT_EQ(exits.error(), "ended the process with code 3");
  const auto throws = runInChild([]() -> std::string { throw std::runtime_error("no"); }, 10'000);
  ASSERT_FALSE(throws);
}

TEST(Wire, GivesBackWhatWasPackedAndNoticesAnEarlyEnd) {
  Packer packer;
  packer.number(7u);
  packer.number(-0.125);
  packer.text("abc");
  packer.text("");
  const std::string bytes = packer.take();
  Unpacker whole(bytes);
  EXPECT_EQ(whole.count(), 7u);
  EXPECT_EQ(whole.real(), -0.125);
  EXPECT_EQ(whole.text(), "abc");
  EXPECT_EQ(whole.text(), "");
  EXPECT_TRUE(whole.good());
  for (size_t length = 0; length < bytes.size(); ++length) {
    const std::string part = bytes.substr(0, length);
    Unpacker cut(part);
    cut.count();
    cut.real();
    cut.text();
    cut.text();
    EXPECT_FALSE(cut.good()) << length;
  }
}

}  // namespace
}  // namespace hapticd::host
