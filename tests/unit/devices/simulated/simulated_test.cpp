// SPDX-License-Identifier: MIT
#include <random>

#include "module.hpp"
#include "stroke.hpp"

namespace hapticd::simulated {
namespace {

using Eigen::Vector3d;

TEST(Simulated, GivesTheSameBitsForTheSameSeedAndOthersForAnother) {
  std::vector<double> runs[3];
  for (int run = 0; run < 3; ++run) {
    Module arm;
    arm.set("hand.tremor", 0.2);
    arm.set("seed", run == 2 ? 8 : 7);
    runs[run] = strokeOf(arm);
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_NE(runs[0], runs[2]);
}

TEST(Simulated, ChangesByLessThanTwoCountsWhenTheStepIsHalved) {
  Module coarse, fine;
  fine.set("substep", 1e-4);
  const auto a = strokeOf(coarse), b = strokeOf(fine);
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  EXPECT_LT(worst, 2 * 2 * M_PI / (4096 * 11.2));
}

// A loop that wakes a little late each time would otherwise run slower by that much.
TEST(Simulated, HasASampleEachPeriodHoweverLateTheLastWasRead) {
  Module arm;
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  const uint64_t start = arm.now_ns;
  arm.read(0);
  for (uint64_t k = 1; k < 100; ++k) {
    const uint64_t due = arm.nextSample(UINT64_MAX);
    EXPECT_EQ(due, start + k * kMillisecond);
    arm.read(due - arm.now_ns + k * 5000);
  }
  arm.read(2 * kMillisecond + kMillisecond / 2);  // two are lost; the next is on time
  EXPECT_EQ((arm.nextSample(UINT64_MAX) - start) % kMillisecond, 0u);
  EXPECT_LE(arm.nextSample(UINT64_MAX), arm.now_ns + kMillisecond);
  EXPECT_EQ(arm.nextSample(arm.now_ns + 7), arm.now_ns + 7);
}

TEST(Simulated, TheHandHoldsItsButtonAtTheGivenTimes) {
  Module none, arm;
  ASSERT_EQ(none.start(), HSP_OK) << none.said;
  EXPECT_EQ(none.info.buttons, 0u);
  Module wrong;
  wrong.set("hand.pressed", std::vector<double>{1, 2, 4, 3});
  EXPECT_LT(wrong.start(), 0);
  EXPECT_NE(wrong.said.find("hand.pressed: row 2 ends before it begins"), std::string::npos) << wrong.said;
  arm.set("hand.pressed", std::vector<double>{0.01, 0.03, 0.04, 0.05});
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  EXPECT_EQ(arm.info.buttons, 1u);
  for (int i = 1; i < 70; ++i) {
    const bool down = (i >= 10 && i < 30) || (i >= 40 && i < 50);
    EXPECT_EQ(arm.read(kMillisecond).buttons, down ? 1u : 0u) << "after " << i << " ms";
  }
}

TEST(Simulated, IsLostAndHasNoMotorsWhileItIsUnplugged) {
  Module arm, plugged;
  arm.set("hand.unplugged", std::vector<double>{0.01, 0.03});
  for (Module* one : {&arm, &plugged}) {
    one->set("hand.script", kNone);
    ASSERT_EQ(one->start(), HSP_OK) << one->said;
  }
  double moved = 0, pushed = 0;  // [rad] by 5 mN m from 10 ms to 30 ms
  for (int i = 1; i < 50; ++i) {
    const bool lost = i >= 10 && i < 30;
    EXPECT_EQ((arm.read(kMillisecond).flags & HDV_S_LOST) != 0, lost) << "after " << i << " ms";
    plugged.read(kMillisecond);
    if (i == 10) moved = -arm.sample.position[0], pushed = -plugged.sample.position[0];
    if (i == 29) moved += arm.sample.position[0], pushed += plugged.sample.position[0];
    for (Module* one : {&arm, &plugged}) one->write(HDV_TORQUE, lost ? Vector3d(0.005, 0, 0) : Vector3d(0, 0, 0));
  }
  EXPECT_EQ(moved, 0);
  EXPECT_GT(pushed, 1e-4);
}

TEST(Simulated, ReportsWholeEncoderCounts) {
  Module arm;
  strokeOf(arm, 300);
  const double gears[] = {13.3, 11.2, 11.2};
  for (int i = 0; i < 3; ++i) {
    const double counts = arm.sample.position[i] * gears[i] * 4096 / (2 * M_PI);
    EXPECT_NEAR(counts, std::round(counts), 1e-9);
  }
}

TEST(Simulated, StaysFiniteAndWithinItsStopsWhateverTheMotorsDo) {
  std::mt19937 random(3);
  for (const double grip : {0.0, 1e5}) {
    Module arm;
    arm.set("hand.script", grip > 0 ? kStroke : kNone);
    arm.set("hand.stiffness", grip), arm.set("hand.damping", grip / 10), arm.set("hand.mass", 0.0);
    ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
    for (int i = 0; i < 20000; ++i) {
      Vector3d torque;
      for (int j = 0; j < 3; ++j) torque[j] = std::uniform_real_distribution<double>(-1e6, 1e6)(random);
      if (i / 1000 % 2 == 0) torque = Vector3d(1e300, -1e300, 1e300);
      arm.read(kMillisecond);
      arm.write(HDV_TORQUE, torque);
      ASSERT_TRUE(arm.joints().allFinite());
      for (int j = 0; j < 3; ++j) {
        ASSERT_GT(arm.sample.position[j], arm.info.position_min[j] - 0.3);
        ASSERT_LT(arm.sample.position[j], arm.info.position_max[j] + 0.3);
      }
    }
  }
}

TEST(Simulated, TakesNoTorqueThatIsNotANumberAndNoneWhenOff) {
  Module free, nan, off;
  for (Module* arm : {&free, &nan, &off}) {
    arm->set("hand.script", kNone);
    ASSERT_EQ(arm->start(), HSP_OK);
    for (int i = 0; i < 200; ++i) {
      arm->read(kMillisecond);
      if (arm == &nan) arm->write(HDV_TORQUE, Vector3d::Constant(std::nan("")));
      if (arm == &off) arm->write(HDV_OFF, Vector3d::Ones());
    }
  }
  EXPECT_EQ(free.joints(), nan.joints());
  EXPECT_EQ(free.joints(), off.joints());
}

TEST(Simulated, FloatsWithGravityCompensatedAndFallsWithout) {
  Module held, falling;
  for (Module* arm : {&held, &falling}) {
    arm->set("hand.script", kNone);
    arm->set("joint.friction", std::vector<double>{0});
    ASSERT_EQ(arm->start(), HSP_OK);
    const Vector3d before = arm->tip();  // at rest in the neutral pose
    for (int i = 0; i < 1000; ++i) {
      if (arm == &held) arm->write(HDV_TORQUE, arm->torqueOf(Vector3d::Zero()));
      arm->read(kMillisecond);
    }
    const double moved = (arm->tip() - before).norm();
    if (arm == &held)
      EXPECT_LT(moved, 6e-5);  // two encoder counts
    else
      EXPECT_GT(moved, 1e-2);
  }
}

TEST(Simulated, AForceMovesTheHandByForceOverStiffness) {
  Module arm;
  arm.set("hand.script", kHold);
  arm.set("hand.radius", 0.0), arm.set("hand.approach", 0.0);
  arm.set("hand.stiffness", 500), arm.set("hand.damping", 30);
  arm.set("joint.friction", std::vector<double>{0});
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  const Vector3d force(0.5, -0.7, 1.0);
  for (int i = 0; i < 3000; ++i) {
    arm.read(kMillisecond);
    arm.write(HDV_TORQUE, arm.torqueOf(force));
  }
  EXPECT_LT((arm.tip() - force / 500).norm(), 6e-5);  // two encoder counts
}

TEST(Simulated, DoesNotDependOnHowOftenItIsReadWhileACommandHolds) {
  Module often, seldom;
  for (Module* arm : {&often, &seldom}) {
    ASSERT_EQ(arm->start(), HSP_OK);
    arm->write(HDV_TORQUE, Vector3d(0.02, 0.02, 0.02));
    const uint64_t period = arm == &often ? kMillisecond : 2 * kMillisecond;
    for (uint64_t t = 0; t < 500 * kMillisecond; t += period) arm->read(period);
  }
  EXPECT_LT((often.tip() - seldom.tip()).norm(), 6e-5);
}

TEST(Simulated, RepeatsASampleWhenTimeStandsStill) {
  Module arm;
  ASSERT_EQ(arm.start(), HSP_OK);
  const uint64_t first = arm.read(kMillisecond).sequence;
  const Eigen::VectorXd q = arm.joints();
  EXPECT_EQ(arm.read(0).sequence, first);
  EXPECT_EQ(arm.joints(), q);
  EXPECT_EQ(arm.read(kMillisecond).sequence, first + 1);
}

TEST(Simulated, DelaysCommandsByWholeReads) {
  for (const int delay : {0, 1, 5}) {
    Module arm, still;
    for (Module* each : {&arm, &still}) {
      each->set("delay", delay), each->set("hand.script", kNone), each->set("joint.counts", std::vector<double>{0});
      ASSERT_EQ(each->start(0), HSP_OK);
    }
    int late = -1;
    for (int i = 0; i < 12 && late < 0; ++i) {
      arm.write(HDV_TORQUE, Vector3d(0.1, 0, 0));
      still.write(HDV_TORQUE, Vector3d::Zero());
      arm.read(kMillisecond), still.read(kMillisecond);
      if ((arm.joints() - still.joints()).norm() > 1e-9) late = i;
    }
    EXPECT_EQ(late, delay);
  }
}

TEST(Simulated, LetsAProgramLeadTheHandAndTellsItTheTruth) {
  Module arm;
  arm.set("hand.script", kGuided), arm.set("joint.friction", std::vector<double>{0});
  arm.set("hand.stiffness", 500), arm.set("hand.damping", 30);
  const hdv_ext_hand& hand = arm.hand();
  ASSERT_EQ(arm.start(), HSP_OK) << arm.said;
  const Vector3d wanted(0.01, -0.02, 0.03), rest(0, 0, 0), pull(1, 0.5, -0.5);
  EXPECT_EQ(hand.guide(arm.handle(), wanted.data(), rest.data(), pull.data()), HSP_OK);
  for (int i = 0; i < 3000; ++i) {
    arm.read(kMillisecond);
    arm.write(HDV_TORQUE, arm.torqueOf(Vector3d::Zero()));
  }
  Vector3d tip, velocity, force;
  ASSERT_EQ(hand.truth(arm.handle(), tip.data(), velocity.data(), force.data()), HSP_OK);
  EXPECT_LT((tip - wanted - pull / 500).norm(), 1e-6);
  EXPECT_LT((tip - arm.tip()).norm(), 6e-5);
  EXPECT_LT(velocity.norm(), 1e-6);
  EXPECT_LT(force.norm(), 1e-4) << "nothing pushes back";
  const Vector3d nan = Vector3d::Constant(std::nan(""));
  EXPECT_LT(hand.guide(arm.handle(), nan.data(), rest.data(), rest.data()), 0);
}

TEST(Simulated, SaysWhyAHandCannotBeWhereTheScriptWantsIt) {
  Module arm;
  arm.set("hand.center", std::vector<double>{2, 0, 0});
  EXPECT_LT(arm.start(), 0);
  EXPECT_NE(arm.said.find("cannot reach"), std::string::npos) << arm.said;
}

TEST(Simulated, SaysWhichListHasTheWrongLength) {
  Module arm;
  arm.set("joint.damping", std::vector<double>{1, 2});
  EXPECT_LT(arm.start(), 0);
  EXPECT_NE(arm.said.find("joint.damping: 2 numbers, expected 1 or 3"), std::string::npos) << arm.said;
  Module chain;
  chain.set("arm.kind", 1);
  EXPECT_LT(chain.start(), 0);
  EXPECT_NE(chain.said.find("arm.dh: has no rows"), std::string::npos) << chain.said;
}

}  // namespace
}  // namespace hapticd::simulated
