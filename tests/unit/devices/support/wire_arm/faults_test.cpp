// SPDX-License-Identifier: MIT
/// What an arm that sends wrong, old, few or no reports has: each fault ends the force within 20 ms, has its own name,
/// and is over when the hardware is well again.
#include <gtest/gtest.h>

#include <vector>

#include "session_rig.hpp"

namespace hapticd::wire_arm {
namespace {

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

}  // namespace
}  // namespace hapticd::wire_arm
