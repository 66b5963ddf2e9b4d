// SPDX-License-Identifier: MIT
/// Faults at the level of bytes, in virtual time: each ends the force within 20 ms, has a name, and is over when the
/// hardware is well again.
#include "wire_arm/session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "emulators/board.hpp"
#include "emulators/wire_file.hpp"

namespace hapticd::wire_arm {
namespace {

constexpr Nanoseconds kMs = 1'000'000;

/// A board at 1 kHz and a host that pushes all the time; time runs in steps of 250 us.
class Rig {
 public:
  explicit Rig(Calibration calibration = Calibration::kDevice)
      : wire_(codec::readWire(emulator::wireOf(HAPTICD_SOURCE_DIR "/config/devices/premium15.yaml"), 3)),
        session_(wire_, settings(calibration)) {
    session_.attach(now_, {}, calibration == Calibration::kPose);
  }

  using Spoil = std::function<bool(std::vector<uint8_t>&)>;  ///< false: nothing is sent

  /// Runs for some time; `spoil` may change what the board sends.
  void run(double seconds, const Spoil& spoil = {}) {
    const Nanoseconds until = now_ + static_cast<Nanoseconds>(seconds * 1e9);
    while (now_ < until) {
      now_ += kMs / 4;
      if (++quarter_ % 4 == 0) {
        ++board.sequence;
        std::vector<uint8_t> bytes = board.bytes();
        if (attached && (!spoil || spoil(bytes))) session_.receive(now_, bytes);
        if (host_writes)
          command_.time = now_, ++command_.sequence, command_.on = true, command_.torque = {0.1, 0.1, 0.1};
      }
      session_.watch(now_);
      std::array<uint8_t, 64> out{};
      const emulator::BoardCommand command({out.data(), session_.command(now_, command_, out)});
      ASSERT_TRUE(command.valid);
      current_ = command.enabled ? command.current[0] : 0;
      if (command.pushes()) pushed_at_ = now_;
    }
  }

  /// Time from `since` to the last command that pushed [s].
  double pushedFor(Nanoseconds since) const {
    return pushed_at_ > since ? static_cast<double>(pushed_at_ - since) * 1e-9 : 0;
  }
  bool pushes() const { return pushed_at_ == now_; }

  static SessionSettings settings(Calibration calibration) {
    SessionSettings s;
    s.calibration = calibration;
    return s;
  }

  emulator::BoardState board;
  bool attached = true, host_writes = true;
  codec::Wire wire_;
  Session session_;
  ArmCommand command_;
  Nanoseconds now_ = 1000 * kMs, pushed_at_ = 0;
  int quarter_ = 0, current_ = 0;
};

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

struct Fault {
  const char* name;
  Trouble trouble;
  Rig::Spoil spoil;
};

class Faults : public ::testing::TestWithParam<Fault> {};

TEST_P(Faults, EndTheForceWithinTwentyMillisecondsAndPass) {
  Rig rig;
  rig.run(0.5);
  ASSERT_TRUE(rig.pushes());
  const Nanoseconds since = rig.now_;
  rig.run(0.3, GetParam().spoil);
  EXPECT_LE(rig.pushedFor(since), 0.020);
  EXPECT_EQ(rig.session_.trouble(), GetParam().trouble) << describe(rig.session_.trouble());
  rig.run(0.1);
  EXPECT_FALSE(rig.pushes()) << "well for too short a time";
  rig.run(0.2);
  EXPECT_EQ(rig.session_.trouble(), Trouble::kNone);
  EXPECT_TRUE(rig.pushes());
  EXPECT_LT(rig.current_, 300) << "comes back in a ramp";
}

TEST_P(Faults, HaveTheirNameFromTheFirst) {
  Rig rig;
  rig.run(0.5);
  for (int ms = 0; ms < 100 && rig.session_.trouble() == Trouble::kNone; ++ms) rig.run(0.001, GetParam().spoil);
  EXPECT_EQ(rig.session_.trouble(), GetParam().trouble) << describe(rig.session_.trouble());
}

int g_count = 0;
INSTANTIATE_TEST_SUITE_P(
    Each, Faults,
    ::testing::Values(Fault{"silence", Trouble::kStale, [](auto&) { return false; }},
                      Fault{"short", Trouble::kShort, [](auto& b) { return b.resize(20), true; }},
                      Fault{"long", Trouble::kShort, [](auto& b) { return b.resize(40), true; }},
                      Fault{"empty", Trouble::kShort, [](auto& b) { return b.clear(), true; }},
                      Fault{"corrupt", Trouble::kCorrupt, [](auto& b) { return b[12] ^= 0x40, true; }},
                      Fault{"firmware", Trouble::kFirmware, [](auto& b) { return b[0] = 2, true; }},
                      Fault{"half_rate", Trouble::kSlow, [](auto&) { return ++g_count % 2 == 0; }},
                      Fault{"repeated", Trouble::kOld,
                            [](auto& b) {
                              emulator::BoardState same;
                              same.sequence = 9;
                              return b = same.bytes(), true;
                            }},
                      Fault{"alternating", Trouble::kOld,  // a board that is stuck between its two buffers
                            [](auto& b) {
                              emulator::BoardState buffer;
                              buffer.sequence = static_cast<uint16_t>(40000 + g_count++ % 2);
                              return b = buffer.bytes(), true;
                            }},
                      Fault{"counts_down", Trouble::kOld,
                            [](auto& b) {
                              emulator::BoardState down;
                              down.sequence = static_cast<uint16_t>(60000 - g_count++);
                              return b = down.bytes(), true;
                            }},
                      Fault{"hardware", Trouble::kHardware,
                            [](auto& b) {
                              emulator::BoardState hot;
                              hot.state = 1 | 8;
                              hot.sequence = static_cast<uint16_t>(b[2] | b[3] << 8);
                              return b = hot.bytes(), true;
                            }}),
    [](const auto& param) { return param.param.name; });

TEST(Session, HalfOfItsReportsAreCorruptAndThatIsWhyItIsSlow) {
  Rig rig;
  rig.run(0.5);
  int n = 0;
  rig.run(0.6, [&](auto& bytes) { return ++n % 2 == 0 ? (bytes[9] ^= 1, true) : true; });
  EXPECT_EQ(rig.session_.trouble(), Trouble::kCorrupt) << describe(rig.session_.trouble());
}

/// Many boards send 125 reports a second until somebody corrects the interval of their endpoint.
TEST(Session, AnArmOfALowerRateThanItsFileSaysIsSlowAndNotSilent) {
  for (const int every : {2, 4, 6, 8, 10, 14}) {
    Rig rig;
    int n = 0;
    const auto some = [&](auto&) { return ++n % every == 0; };
    rig.run(0.5, some);
    for (int ms = 0; ms < 300; ++ms) {
      rig.run(0.001, some);
      ASSERT_EQ(rig.session_.trouble(), Trouble::kSlow)
          << "every " << every << " ms: " << describe(rig.session_.trouble());
    }
    rig.run(0.1, [](auto&) { return false; });
    EXPECT_EQ(rig.session_.trouble(), Trouble::kStale) << "but then it is silent";
  }
}

TEST(Session, TwoFaultsAtOnceHaveOneName) {
  Rig rig;
  rig.run(0.5);
  int n = 0, changes = 0;
  const auto both = [&](auto& bytes) { return ++n % 2 == 0 ? bytes.resize(20), true : (bytes[9] ^= 1, true); };
  Trouble last = Trouble::kNone;
  for (int ms = 0; ms < 300; ++ms) {
    rig.run(0.001, both);
    changes += rig.session_.trouble() != last;
    last = rig.session_.trouble();
  }
  EXPECT_EQ(changes, 1);
}

TEST(Session, ABoardThatSendsItsLastReportTwiceIsSilentThen) {
  Rig rig;
  rig.run(0.5);
  rig.run(0.001, [last = rig.board.bytes()](auto& bytes) { return bytes = last, true; });
  rig.run(0.3, [](auto&) { return false; });
  EXPECT_EQ(rig.session_.trouble(), Trouble::kStale) << describe(rig.session_.trouble());
}

TEST(Session, SomeBadReportsAreNoFault) {
  Rig rig;
  rig.run(0.5);
  int n = 0;
  rig.run(0.3, [&](auto& bytes) { return ++n % 20 == 0 ? (bytes[9] ^= 1, true) : true; });
  EXPECT_EQ(rig.session_.trouble(), Trouble::kNone);
  EXPECT_TRUE(rig.pushes());
  EXPECT_GT(rig.session_.badReports(), 10u);
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
