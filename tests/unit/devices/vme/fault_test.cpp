// SPDX-License-Identifier: MIT
/// Faults of a controller board, in virtual time: each ends the force within 20 ms, has a name, and is over when the
/// board is well again.
#include "rig.hpp"

namespace hapticd::vme {
namespace {

using emulator::VmeFault;
using wire_arm::Trouble;

TEST(VmeSession, AHealthyBoardGetsItsTorqueAfterARamp) {
  Rig rig("healthy");
  rig.run(0.2);  // the board calibrates for a tenth of a second
  ASSERT_EQ(rig.session.trouble(), Trouble::kNone) << describe(rig.session.trouble());
  const double early = rig.torque;
  rig.run(0.4);
  EXPECT_GT(early, 0);
  EXPECT_LT(early, 0.45);
  EXPECT_NEAR(rig.torque, 0.5, 0.005);
  EXPECT_TRUE(rig.board.pushed());
  EXPECT_GT(rig.board.commands(), 500u);
}

TEST(VmeSession, SamplesAreTheArmsJointsAndLoadCells) {
  Rig rig("samples");
  rig.run(0.5);
  const hdv_sample& truth = rig.board.truth();
  const wire_arm::Sample& sample = rig.session.sample();
  for (size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(sample.position[i], truth.position[i], 1e-3) << i;  // a block late, and a count
    EXPECT_NEAR(sample.torque[i], truth.torque[i], 0.5) << i;
  }
  EXPECT_NEAR(sample.position[8], 0.3, 5e-5);
  EXPECT_NEAR(sample.position[9], -0.1, 5e-5);
}

struct Case {
  const char* name;
  VmeFault fault;
  Trouble trouble;
};

class VmeFaults : public ::testing::TestWithParam<Case> {};

TEST_P(VmeFaults, EndTheForceWithinTwentyMillisecondsAndPass) {
  Rig rig(GetParam().name);
  rig.run(0.8);
  ASSERT_TRUE(rig.open());
  const Nanoseconds since = rig.now;
  rig.board.spoil(GetParam().fault);
  rig.run(0.3);
  EXPECT_LE(rig.openFor(since), 0.020);
  EXPECT_FALSE(rig.board.pushed());
  EXPECT_EQ(rig.session.trouble(), GetParam().trouble) << describe(rig.session.trouble());
  rig.board.spoil(VmeFault::kNone);
  rig.run(0.1);
  EXPECT_FALSE(rig.open()) << "well for too short a time";
  rig.run(0.32);
  EXPECT_EQ(rig.session.trouble(), Trouble::kNone) << describe(rig.session.trouble());
  EXPECT_TRUE(rig.open());
  EXPECT_LT(rig.torque, 0.5) << "comes back in a ramp";
  rig.run(0.3);
  EXPECT_NEAR(rig.torque, 0.5, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Each, VmeFaults,
                         ::testing::Values(Case{"silent", VmeFault::kSilent, Trouble::kStale},
                                           Case{"torn", VmeFault::kTorn, Trouble::kTorn},
                                           Case{"corrupt", VmeFault::kCorrupt, Trouble::kCorrupt},
                                           Case{"protocol", VmeFault::kProtocol, Trouble::kFirmware},
                                           Case{"hydraulics", VmeFault::kHydraulics, Trouble::kHardware},
                                           Case{"in_turn", VmeFault::kInTurn, Trouble::kOld},
                                           Case{"half_rate", VmeFault::kHalfRate, Trouble::kSlow},
                                           Case{"absent", VmeFault::kAbsent, Trouble::kAbsent}),
                         [](const auto& param) { return param.param.name; });

TEST(VmeSession, AnEncoderJumpEndsTheForceAtOnce) {
  Rig rig("jump");
  rig.run(0.8);
  const Nanoseconds since = rig.now;
  rig.board.spoil(VmeFault::kJump);
  rig.run(0.05);
  EXPECT_LE(rig.openFor(since), 0.002);
  EXPECT_EQ(rig.session.trouble(), Trouble::kJump);
  rig.board.spoil(VmeFault::kNone);
  rig.run(1);
  EXPECT_TRUE(rig.open()) << "the board knows its zero";
}

TEST(VmeSession, ABoardThatStartsAnewIsNamedAndPushedOnlyOnceCalibrated) {
  Rig rig("restart");
  rig.run(0.8);
  const Nanoseconds since = rig.now;
  rig.board.restart();
  rig.run(0.05);
  EXPECT_LE(rig.openFor(since), 0.002);
  EXPECT_EQ(rig.session.trouble(), Trouble::kReset);
  EXPECT_FALSE(rig.session.sample().calibrated);
  rig.run(0.6);
  EXPECT_TRUE(rig.open());
}

TEST(VmeSession, AWindowThatSomebodyCutsShortIsABusErrorUntilItIsBack) {
  Rig rig("short");
  rig.run(0.8);
  const Nanoseconds since = rig.now;
  rig.powered = false;  // the board's writes would make the file longer again
  rig.file.resize(40);
  rig.run(0.3);
  EXPECT_LE(rig.openFor(since), 0.002);
  EXPECT_EQ(rig.session.trouble(), Trouble::kBusError);
  EXPECT_NE(rig.refusal.find("ends after 40 bytes"), std::string::npos) << rig.refusal;
  rig.file.resize(0);
  rig.run(0.2);
  EXPECT_NE(rig.refusal.find("the window returns no bytes"), std::string::npos) << rig.refusal;
  rig.file.resize(0x10000);
  rig.powered = true;
  rig.run(1);
  EXPECT_TRUE(rig.open());
}

TEST(VmeSession, WhenTheHostDiesTheBoardLetsGo) {
  Rig rig("host");
  rig.run(0.8);
  ASSERT_TRUE(rig.board.pushed());
  const emulator::VmeBlock last = rig.file.read(0x100);
  emulator::VmeBlock state{};
  for (int i = 0; i < 15; ++i) rig.board.cycle(last, state, 1 / 1500.0);
  EXPECT_TRUE(rig.board.pushed());
  for (int i = 0; i < 20; ++i) rig.board.cycle(last, state, 1 / 1500.0);
  EXPECT_FALSE(rig.board.pushed());
}

}  // namespace
}  // namespace hapticd::vme
