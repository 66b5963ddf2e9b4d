// SPDX-License-Identifier: MIT
#include "host/child.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>

#include "host/describe.hpp"
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
  EXPECT_EQ(hang.error(), "took longer than 0.1 s");
  const auto exits = runInChild([]() -> std::string { ::_exit(3); }, 10'000);
  ASSERT_FALSE(exits);
  EXPECT_EQ(exits.error(), "ended the process with code 3");
  const auto throws = runInChild([]() -> std::string { throw std::runtime_error("no"); }, 10'000);
  ASSERT_FALSE(throws);
}

TEST(Child, ThatStaysTooLongInOnePieceOfItsWorkSaysWhere) {
  static ChildProgress progress;
  const auto hang = runInChild(
      []() -> std::string {
        ::signal(SIGPROF, [](int) {
          progress.mark(7, "noted");
          ::_exit(1);
        });
        for (int i = 0; i < 3; ++i) progress.beginPiece();
        for (;;) ::pause();
      },
      600'000, {&progress, 200, {}});
  ASSERT_FALSE(hang);
  EXPECT_EQ(hang.error(), "did not return within 0.2 s");
  EXPECT_EQ(progress.item(), 7u);
  EXPECT_STREQ(progress.call(), "noted");
}

TEST(Child, MayRestBetweenThePiecesOfItsWork) {
  ChildProgress progress;
  const auto told = runInChild(
      [&]() -> std::string {
        progress.beginPiece();
        progress.rest();
        ::usleep(500'000);
        return "x";
      },
      600'000, {&progress, 50, {}});
  EXPECT_TRUE(told) << told.error();
}

TEST(Child, ThatCrashesAfterItsAnswerHasAnsweredAllTheSame) {
  ChildProgress progress;
  const auto told = runInChild(
      []() -> std::string {
        std::atexit([] { ::raise(SIGKILL); });
        return "x";
      },
      600'000, {&progress, 0, {}, true});
  ASSERT_TRUE(told) << told.error();
  EXPECT_EQ(*told, "x");
}

/// The other process keeps the pipe open, through which the answer comes.
TEST(Child, MayLeaveAnotherProcessBehind) {
  const auto told = runInChild(
      []() -> std::string {
        if (::fork() == 0) {
          ::alarm(60);
          for (;;) ::pause();
        }
        return "x";
      },
      30'000);
  ASSERT_TRUE(told) << told.error();
  EXPECT_EQ(*told, "x");
}

TEST(Child, WhoseAnswerWasClosedSaysSo) {
  const auto told = runInChild(
      []() -> std::string {
        for (int fd = 3; fd < 200; ++fd) ::close(fd);
        return "x";
      },
      600'000);
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error(), "closed a file that it had not opened");
}

/// The process in the middle is killed while its child waits for ever; the pipe closes when the child has ended, too.
TEST(Child, EndsWithItsParent) {
  int ends[2], begun[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::pipe(begun), 0);
  const pid_t middle = ::fork();
  if (middle == 0) {
    const auto told = runInChild(
        [&]() -> std::string {
          EXPECT_EQ(::write(begun[1], "x", 1), 1);
          for (;;) ::pause();
        },
        600'000);
    ::_exit(0);
  }
  ::close(ends[1]);
  char byte = 0;
  ASSERT_EQ(::read(begun[0], &byte, 1), 1);
  ::kill(middle, SIGKILL);
  EXPECT_EQ(::read(ends[0], &byte, 1), 0);
}

void burn(double seconds, clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  const double end = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) + seconds;
  while (static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) < end) clock_gettime(clock, &now);
}

/// Computes for 0.2 s while five others want the same processor.
std::string workAmongOthers() {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(sched_getcpu(), &one);
  sched_setaffinity(0, sizeof one, &one);
  pid_t others[5];
  for (pid_t& other : others) {
    if ((other = fork()) != 0) continue;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    burn(20, CLOCK_MONOTONIC);
    _exit(0);
  }
  burn(0.2, CLOCK_THREAD_CPUTIME_ID);
  for (const pid_t other : others) kill(other, SIGKILL);
  return "done";
}

// It takes more than a second here, of which it stands ready, without a processor, for most.
TEST(Child, IsNotBlamedForTheTimeThatOthersTook) {
  if (access("/proc/self/schedstat", R_OK) != 0) GTEST_SKIP() << "this kernel does not count it";
  constexpr int kLimitMs = 500;
  const auto begun = std::chrono::steady_clock::now();
  const auto told = runInChild(workAmongOthers, kLimitMs);
  const auto took = std::chrono::steady_clock::now() - begun;
  if (!told && took >= 9 * std::chrono::milliseconds(kLimitMs))
    GTEST_SKIP() << "even ten times the limit was too little here";
  ASSERT_TRUE(told) << told.error();
  EXPECT_EQ(*told, "done");
}

TEST(Program, DescribesAFileAsAForkDoesAndTellsHowABadOneEnds) {
  const std::filesystem::path modules = TEST_MODULES;
  const auto plain = describeInChild(modules / "good/test_shape.so");
  const auto told = describeByProgram(TEST_HAPTICD, modules / "good/test_shape.so");
  ASSERT_TRUE(told) << told.error();
  ASSERT_EQ(told->size(), plain->size());
  EXPECT_EQ(told->front().id, plain->front().id);
  EXPECT_EQ(told->front().paramIds(), plain->front().paramIds());
  for (const char* bad : {"crash", "exits", "wrong_major", "no_entry", "broken_table"}) {
#ifdef HAPTICD_SANITIZED  // the sanitizers handle a crash in the program themselves
    if (std::string(bad) == "crash") continue;
#endif
    const std::filesystem::path file = modules / "bad" / (std::string(bad) + ".so");
    const auto refused = describeByProgram(TEST_HAPTICD, file);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error(), describeInChild(file).error()) << bad;
  }
}

std::string fails() {
  throw std::runtime_error("no way out");
}

TEST(Child, ThatThrowsTellsTheWordsOfItsException) {
  const auto thrown = runInChild([]() -> std::string { throw std::runtime_error("the coffee is cold"); }, 5000);
  ASSERT_FALSE(thrown);
  EXPECT_EQ(thrown.error(), "threw an exception: the coffee is cold");
  const auto ended = runInChild([]() noexcept { return fails(); }, 5000);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error(), "threw an exception: no way out");
  const auto silent = runInChild([]() -> std::string { throw 7; }, 5000);
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error(), "threw an exception");
}

TEST(Program, ThatClosesItsDescriptorsAndHangsIsEndedInTime) {
  const auto hangs = runProgram({"/bin/sh", "-c", "exec 3>&-; exec sleep 60"}, 300);
  ASSERT_FALSE(hangs);
  EXPECT_EQ(hangs.error(), "took longer than 0.3 s");
}

TEST(Program, AnswersAParentThatWasStartedWithoutStandardFiles) {
  const auto told = runInChild(
      [] {
        for (int fd = 0; fd < 3; ++fd) close(fd);
        const auto answer = runProgram({"/bin/sh", "-c", "echo hello >&3"}, 10'000);
        return answer ? *answer : answer.error();
      },
      20'000);
  ASSERT_TRUE(told) << told.error();
  EXPECT_EQ(*told, "hello\n");
}

TEST(Program, ThatIsNotThereOrAnswersNothingIsAnError) {
  const auto missing = runProgram({"/nowhere/hapticd", "x"}, 1000);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error(), "could not be tried: /nowhere/hapticd: No such file or directory");
  const auto silent = runProgram({"/bin/true"}, 5000);
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error(), "ended the process with code 0");
  const auto slow = runProgram({"/bin/sleep", "60"}, 100);
  ASSERT_FALSE(slow);
  EXPECT_EQ(slow.error(), "took longer than 0.1 s");
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
