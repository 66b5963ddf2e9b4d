// SPDX-License-Identifier: MIT
/// The I/O thread that authors copy: an arm that falls silent is sent "off" within a bound, whether or not it ever
/// speaks again.
#include "io_thread.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace template_arm {
namespace {

constexpr uint64_t kMillisecond = 1'000'000;

struct TestClock {
  static inline uint64_t time = 0;
  static uint64_t now() noexcept { return time; }
};

/// An arm that reports every millisecond while it speaks; receive() waits as long as it may otherwise.
struct TestPort {
  bool speaks = true;
  std::vector<Vec3> sent;
  bool receive(Vec3& position) noexcept {
    TestClock::time += speaks ? kMillisecond : IoThread<TestPort, TestClock>::kWait;
    position = {0.25, 0, 0};
    return speaks;
  }
  void send(const Vec3& force) noexcept { sent.push_back(force); }
};

class IoThreadTest : public ::testing::Test {
 protected:
  void SetUp() override { TestClock::time = 1000 * kMillisecond; }
  /// Rounds in which the host writes a force of one newton each time.
  void rounds(int count, bool host = true) {
    for (int i = 0; i < count; ++i) {
      if (host) io.leave({TestClock::time, {1, 0, 0}});
      io.exchange();
    }
  }
  double last() const { return port.sent.back()[0]; }

  TestPort port;
  IoThread<TestPort, TestClock> io{port};
};

TEST_F(IoThreadTest, ForcesComeInARampAndReportsOnce) {
  rounds(2);
  EXPECT_GT(last(), 0);
  EXPECT_LT(last(), 0.1);
  Report report;
  EXPECT_TRUE(io.newest(report));
  EXPECT_EQ(report.sequence, 2u);
  EXPECT_EQ(report.position[0], 0.25);
  EXPECT_FALSE(io.newest(report));
  EXPECT_EQ(report.sequence, 2u);
  rounds(60);
  EXPECT_EQ(last(), 1);
}

/// The host still writes: it has not noticed yet.
TEST_F(IoThreadTest, ASilentArmIsSentOffWithinABound) {
  rounds(60);
  const uint64_t fell = TestClock::time;
  port.speaks = false;
  while (last() != 0 && port.sent.size() < 1000) rounds(1);
  EXPECT_EQ(last(), 0);
  EXPECT_LE(TestClock::time - fell, (IoThread<TestPort, TestClock>::kOld + IoThread<TestPort, TestClock>::kWait));
  const size_t before = port.sent.size();
  rounds(100);
  EXPECT_EQ(port.sent.size(), before + 100);  // said again in each round
  EXPECT_EQ(last(), 0);
}

TEST_F(IoThreadTest, AfterASilenceTheForceComesBackInARamp) {
  rounds(60);
  port.speaks = false;
  rounds(10);
  port.speaks = true;
  rounds(2);
  EXPECT_LT(last(), 0.1);
  rounds(60);
  EXPECT_EQ(last(), 1);
}

TEST_F(IoThreadTest, AnOldOrderMovesNoMotor) {
  rounds(60);
  rounds(19, false);  // the newest is 20 ms old now
  EXPECT_EQ(last(), 1);
  rounds(2, false);
  EXPECT_EQ(last(), 0);
}

TEST_F(IoThreadTest, ACutCountsUntilItIsEnded) {
  rounds(60);
  io.cut(true);
  rounds(60);
  EXPECT_EQ(last(), 0);
  io.cut(false);
  rounds(1);
  EXPECT_EQ(last(), 1);
}

TEST_F(IoThreadTest, StopSaysOffLast) {
  rounds(60);
  io.start();
  io.stop();
  EXPECT_EQ(last(), 0);
  const size_t before = port.sent.size();
  io.stop();
  EXPECT_EQ(port.sent.size(), before);
}

}  // namespace
}  // namespace template_arm
