// SPDX-License-Identifier: MIT
/// How a session goes: calibration, lost counts, counters and clocks, arms that come back.
#include "wire_arm/session.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "session_rig.hpp"

namespace hapticd::wire_arm {
namespace {

TEST(Session, AHealthyArmIsPushedAfterARamp) {
  Rig rig;
  rig.run(0.02);
  EXPECT_EQ(rig.session_.trouble(), Trouble::kNone);
  rig.run(0.1);
  const int early = rig.current_;
  rig.run(0.3);
  EXPECT_GT(early, 0);
  EXPECT_LT(early, rig.current_);
  EXPECT_NEAR(rig.current_, 0.1 / (0.0234 * 13.3 / 1000), 1);  // mA
}

TEST(Session, AnUnpluggedArmIsPushedAtOnceNoMoreAndComesBackInARamp) {
  Rig rig;
  rig.run(0.5);
  rig.attached = false;
  rig.session_.lose(rig.now_, Trouble::kUnplugged);
  const Nanoseconds since = rig.now_;
  rig.run(0.3);
  EXPECT_LE(rig.pushedFor(since), 0.0005);
  rig.attached = true;
  rig.board = {};
  rig.session_.attach(rig.now_, {}, false);
  rig.run(0.1);
  EXPECT_FALSE(rig.pushes());
  rig.run(0.2);
  EXPECT_TRUE(rig.pushes());
  EXPECT_LT(rig.current_, 300);
}

TEST(Session, AJumpOfAnEncoderVoidsAPoseCalibration) {
  Rig rig(Calibration::kPose);
  rig.run(0.5);
  ASSERT_TRUE(rig.pushes());
  const Nanoseconds since = rig.now_;
  rig.board.counts[1] += 20000;  // 2.7 rad in a millisecond
  rig.run(2);
  EXPECT_LE(rig.pushedFor(since), 0.001);
  EXPECT_EQ(rig.session_.trouble(), Trouble::kJump);
  EXPECT_FALSE(rig.session_.sample().calibrated);
  rig.session_.setZero({0, 0.25, 0});
  EXPECT_TRUE(rig.session_.sample().calibrated) << "the next read already finds the pose, which calibrate prints";
  EXPECT_DOUBLE_EQ(rig.session_.sample().position[1], rig.session_.raw()[1] + 0.25);
  rig.run(0.5);
  EXPECT_TRUE(rig.pushes());
}

TEST(Session, AnArmThatFindsItsZeroAndLosesCountsMustFindItAnew) {
  Rig rig;
  rig.run(0.5);
  const Nanoseconds since = rig.now_;
  rig.board.counts[1] += 20000;  // 2.7 rad: forces would turn round, and the board still calls itself calibrated
  rig.run(2);
  EXPECT_LE(rig.pushedFor(since), 0.001);
  EXPECT_EQ(rig.session_.trouble(), Trouble::kJump);
  rig.session_.lose(rig.now_, Trouble::kUnplugged);
  rig.session_.attach(rig.now_, {}, false);
  rig.run(2);
  EXPECT_LE(rig.pushedFor(since), 0.001) << "the cable was pulled, and the board had power all the time";
  rig.board.state = 0;
  rig.run(0.5);
  rig.board.state = 1, rig.board.counts[1] -= 20000;
  rig.run(0.5);
  EXPECT_TRUE(rig.pushes()) << describe(rig.session_.trouble());
}

/// A board that counts its starts, finds its zero by itself, and loses counts. Then it restarts, while it is attached
/// or while its cable is out.
TEST(Session, AnArmThatRestartsHasLostNoCounts) {
  const auto wire = codec::readWire(
      R"({"rate":1000,"input":{"size":5,"fields":[{"is":"position","joint":1,"at":0,"type":"i16","scale":0.001},)"
      R"({"is":"starts","at":2,"type":"u8"},{"is":"calibrated","at":3,"type":"u8"},)"
      R"({"is":"counter","at":4,"type":"u8"}]},)"
      R"("output":{"size":2,"fields":[{"is":"torque","joint":1,"at":0,"type":"i16","scale":0.001}]}})",
      1);
  for (const bool cable : {false, true}) {
    SessionSettings settings = Rig::settings(Calibration::kDevice);
    settings.joints = 1;
    Session session(wire, settings);
    Nanoseconds now = kMs;
    uint8_t counter = 0;
    const auto run = [&](uint8_t position, uint8_t starts) {
      for (int i = 0; i < 500; ++i) {
        const std::array<uint8_t, 5> report{0, position, starts, 1, ++counter};
        session.receive(now += kMs, report);
        session.watch(now);
      }
      return session.trouble();
    };
    session.attach(now, {}, false);
    EXPECT_EQ(run(0, 1), Trouble::kNone);
    EXPECT_EQ(run(8, 1), Trouble::kJump) << "2 rad in a millisecond";
    if (cable) session.lose(now, Trouble::kUnplugged), session.attach(now, {}, false);
    EXPECT_EQ(run(8, 2), Trouble::kNone) << cable;
  }
}

TEST(Session, AnArmMayJumpAsItFindsItsZero) {
  Rig rig;
  rig.board.state = 0;
  rig.run(0.5);
  rig.board.state = 1, rig.board.counts = {9000, -9000, 9000};
  rig.run(0.5);
  EXPECT_TRUE(rig.pushes()) << describe(rig.session_.trouble());
}

TEST(Session, AReportThatJumpsAndTheNextOneBackIsASlipOfTheWire) {
  Rig rig;
  rig.run(0.5);
  const Nanoseconds since = rig.now_;
  rig.board.counts[1] += 20000;
  rig.run(0.002);
  rig.board.counts[1] -= 20000;
  rig.run(0.1);
  EXPECT_LE(rig.pushedFor(since), 0.001);
  rig.run(0.4);
  EXPECT_TRUE(rig.pushes());
}

TEST(Session, AJumpOfAbsoluteEncodersPasses) {
  Rig rig(Calibration::kNone);
  rig.run(0.5);
  const Nanoseconds since = rig.now_;
  rig.board.counts[1] += 20000;
  rig.run(0.05);
  EXPECT_LE(rig.pushedFor(since), 0.001);
  EXPECT_EQ(rig.session_.trouble(), Trouble::kJump);
  rig.run(0.5);
  EXPECT_TRUE(rig.pushes());
}

TEST(Session, NothingIsPushedBeforeCalibration) {
  Rig rig;
  rig.board.state = 0;
  rig.run(1);
  EXPECT_EQ(rig.pushed_at_, 0u);
  EXPECT_EQ(rig.session_.trouble(), Trouble::kNone);
  rig.board.state = 1;
  rig.run(0.1);
  EXPECT_TRUE(rig.pushes());
}

TEST(Session, AHostThatStopsWritingLetsGo) {
  Rig rig;
  rig.run(0.5);
  rig.host_writes = false;
  const Nanoseconds since = rig.now_;
  rig.run(0.1);
  EXPECT_LE(rig.pushedFor(since), 0.0205);
}

TEST(Session, CountersThatWrapAreFollowed) {
  const auto wire = codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml"), 3);
  Session session(wire, Rig::settings(Calibration::kNone));
  Nanoseconds now = kMs;
  session.attach(now, {}, true);
  int16_t counts = 0;
  for (int i = 1; i <= 3000; ++i) {  // 60000 counts one way: nearly one turn of the 16-bit counter
    counts = static_cast<int16_t>(static_cast<uint16_t>(counts) + 20);
    std::vector<uint8_t> bytes(14, 0);
    bytes[0] = static_cast<uint8_t>(counts), bytes[1] = static_cast<uint8_t>(static_cast<uint16_t>(counts) >> 8);
    session.receive(now += kMs, bytes);
    ASSERT_NEAR(session.sample().position[0], -i * 20 * 2 * M_PI / 2000 / 16, 1e-9) << i;
    ASSERT_NE(session.trouble(), Trouble::kJump);
  }
}

/// What becomes of reports of an arm without a counter whose clock stands still, after good ones.
Trouble stopped(const char* scale, const char* type = "u16") {
  const std::string text = std::string(R"({"rate":1000,"input":{"size":4,"fields":[)") +
                           R"({"is":"position","joint":1,"at":0,"type":"i16","scale":0.001},)" +
                           R"({"is":"time","at":2,"type":")" + type + R"(","scale":)" + scale +
                           R"(}]},"output":{"size":2,"fields":[)" +
                           R"({"is":"torque","joint":1,"at":0,"type":"i16","scale":0.001}]}})";
  Session session(codec::readWire(text, 1), Rig::settings(Calibration::kNone));
  Nanoseconds now = kMs;
  session.attach(now, {}, true);
  std::array<uint8_t, 64> out{};
  std::vector<uint8_t> bytes(4, 0);
  for (int i = 0; i < 500; ++i, now += kMs) {
    if (i < 400) bytes[2] = static_cast<uint8_t>(i), bytes[3] = static_cast<uint8_t>(i >> 8);
    session.receive(now, bytes);
    (void)session.command(now, ArmCommand{}, out);
    session.watch(now);
    if (i == 399 && session.trouble() != Trouble::kNone) return Trouble::kAbsent;
  }
  return session.trouble();
}

TEST(Session, AClockThatStandsStillIsTheSameReportAgain) {
  EXPECT_EQ(stopped("0.0001"), Trouble::kOld);
  EXPECT_EQ(stopped("0.001"), Trouble::kNone) << "so coarse that two good reports may have the same time";
  EXPECT_EQ(stopped("0.0001", "u4"), Trouble::kNone) << "so narrow that it wraps from report to report";
}

/// Commands of a WoodenHaptics every `period`, of which it answers every `n`th. @return troubles met
Trouble polled(Nanoseconds period, int n) {
  const auto wire = codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/woodenhaptics.yaml"), 3);
  Session session(wire, Rig::settings(Calibration::kNone));
  Nanoseconds now = kMs;
  session.attach(now, {}, true);
  std::array<uint8_t, 64> out{};
  const std::vector<uint8_t> answer(14, 0);
  for (int i = 0; i < 400; ++i, now += period) {
    (void)session.command(now, ArmCommand{}, out);
    if (i % n == 0) session.receive(now + kMs / 10, answer);
    session.watch(now + kMs / 5);
  }
  return session.trouble();
}

TEST(Session, AnArmThatAnswersEachOfFewCommandsIsNotSlow) {
  EXPECT_EQ(polled(kMs, 1), Trouble::kNone);
  EXPECT_EQ(polled(4 * kMs, 1), Trouble::kNone) << "it was asked no more often";
  EXPECT_EQ(polled(kMs, 2), Trouble::kSlow);
}

}  // namespace
}  // namespace hapticd::wire_arm
