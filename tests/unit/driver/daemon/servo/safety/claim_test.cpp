// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "claim_rig.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

TEST(Claim, LetsAClickThrough) {
  Rested click;
  EXPECT_EQ(click.next(at({0, 0, 0}, {0, Claim::kStep, 0})), Vector3d(0, Claim::kStep, 0));
  EXPECT_FALSE(click.held);
  Rested jump({1, 0, 0});
  const Vector3d let = jump.next(at({0, 0, 0}, {1, 5, 0}));
  EXPECT_TRUE(jump.held);
  EXPECT_NEAR((let - Vector3d(1, Claim::kStep, 0)).norm(), 0, 1e-12);
}

TEST(Claim, AForceMayAlwaysShrinkAndNeverTurnRound) {
  Rested shrinks({0, 8, 0});
  for (const double part : {0.9, 0.5, 0.1, 0.0}) {
    EXPECT_EQ(shrinks.next(at({0, 0, 0}, {0, 8 * part, 0})), Vector3d(0, 8 * part, 0));
    EXPECT_FALSE(shrinks.held);
  }
  Rested turns({0, 8, 0});
  EXPECT_NEAR((turns.next(at({0, 0, 0}, {0, -8, 0})) - Vector3d(0, -Claim::kStep, 0)).norm(), 0, 1e-12);
  EXPECT_TRUE(turns.held);
  EXPECT_NEAR((turns.next(at({0, 0, 0}, {0, 8, 0})) - Vector3d(0, Claim::kStep, 0)).norm(), 0, 0.2) << "and back";
  Rested aside({0, 8, 0});
  EXPECT_NEAR(aside.next(at({0, 0, 0}, {8, 0, 0})).norm(), Claim::kStep, 1e-12) << "as a vector, not by its length";
}

TEST(Claim, NeverLetsMoreThanWasAsked) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  Rested claim;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d force(8 * any(random), 8 * any(random), 8 * any(random));
    const Vector3d let = claim.next(at(Vector3d(any(random), any(random), any(random)) * 1e-4, force));
    ASSERT_LE(let.norm(), force.norm() * (1 + 1e-12));
    ASSERT_EQ(let == force, !claim.held);
  }
}

TEST(Claim, OfStiffnessExplainsWhatTheProbeMoved) {
  ClaimBounds bounds;
  bounds.stiffness = 1000;
  for (const double force : {10.0 + Claim::kStep - 1e-9, 10.0 + Claim::kStep + 0.1}) {
    Rested pressed(Vector3d::Zero(), bounds);
    const Vector3d let = pressed.next(at({0, -1e-3, 0}, {0, force, 0}));  // 10 * 1000 N/m * 1 mm
    EXPECT_EQ(pressed.held, force > 10 + Claim::kStep);
    EXPECT_NEAR(let.y(), 10 + Claim::kStep, 1e-8);
  }
  Rested unclaimed;
  EXPECT_NEAR(unclaimed.next(at({0, -1e-4, 0}, {0, 50, 0})).y(),
              Claim::kMargin * Claim::kUnclaimed * 1e-4 + Claim::kStep, 1e-9);
}

TEST(Claim, OfDampingExplainsSpeed) {
  ClaimBounds bounds;
  bounds.damping = 30;
  bounds.stiffness = 1e-9;
  Rested damped(Vector3d::Zero(), bounds);
  ClaimStep step = at({0, 0, 0}, {0, 1000, 0});
  step.velocity = {0, 0.5, 0};
  EXPECT_NEAR(damped.next(step).y(), Claim::kMargin * 30 * 0.5 + Claim::kStep, 1e-6);
  Rested by_way(Vector3d::Zero(), bounds);
  EXPECT_NEAR(by_way.next(at({0.5e-3, 0, 0}, {0, 1000, 0})).y(), Claim::kMargin * 30 * 0.5 + Claim::kStep, 1e-6);
  bounds.damping = 0;
  Rested undamped(Vector3d::Zero(), bounds);
  EXPECT_NEAR(undamped.next(step).y(), Claim::kDamping * 0.5 + Claim::kStep, 1e-6) << "every shape may rub";
  step.velocity.setZero();
  step.force = {0, -1000, 0};
  EXPECT_NEAR(undamped.next(step).norm(), Claim::kDamping * 0.5 + Claim::kStep, 1e-6) << "as the hand stops too";
}

TEST(Claim, WhatNothingExplainsMayDriftSlowly) {
  Rested drifts;
  double force = 0, last = 0;
  for (int i = 0; i < 1000; ++i) {  // at half the speed
    force += 0.5 * Claim::kDrift * kTick;
    last = drifts.next(at({0, 0, 0}, {0, force, 0})).y();
    ASSERT_FALSE(drifts.held) << i;
  }
  EXPECT_NEAR(last, 50, 1e-9);
  Rested fast;
  int held = 0;
  for (int i = 1; i <= 1000; ++i) {  // at twice
    last = fast.next(at({0, 0, 0}, {0, 2 * Claim::kDrift * kTick * i, 0})).y();
    held += fast.held ? 1 : 0;
    ASSERT_LE(last, Claim::kStep + Claim::kDrift * kTick * i + 1e-9);
  }
  EXPECT_GT(held, 900);
}

/// A vibration moves about what is explained: by a jump, and no more.
TEST(Claim, AVibrationIsBoundedByTheJumpThatIsReported) {
  for (const double jump : {0.0, 4.0})
    for (const double size : {1.9, 3.9, 8.0}) {
      ClaimBounds bounds;
      bounds.jump = jump;
      Rested vibrates(Vector3d::Zero(), bounds);
      double most = 0;
      int held = 0;
      for (int i = 0; i < 2000; ++i) {
        most = std::max(most, vibrates.next(at({0, 0, 0}, {0, i % 2 == 0 ? size : -size, 0})).norm());
        held += vibrates.held ? 1 : 0;
      }
      const double bound = std::max(jump, Claim::kStep);
      EXPECT_EQ(held > 0, size > bound) << size << " N";
      EXPECT_LE(most, std::min(size, bound + 2 * Claim::kDrift * kTick) + 1e-9);
      if (size > bound) {
        EXPECT_GT(held, 1990);
      }
    }
}

/// A probe at rest at the origin, on an arm that lets so much through [N].
ClaimStep limited(double most, const Vector3d& force) {
  ClaimStep step = at({0, 0, 0}, force);
  step.max_force = most;
  return step;
}

TEST(Claim, ComparesForcesOnlyAsFarAsTheArmLetsThem) {
  Rested clipped({0, 8.4, 0});
  EXPECT_EQ(clipped.next(limited(8.5, {0, 300, 0})), Vector3d(0, 300, 0)) << "the limit cuts it to 8.5 N";
  EXPECT_FALSE(clipped.held);
  EXPECT_EQ(clipped.next(limited(8.5, {0, 8.4, 0})), Vector3d(0, 8.4, 0));
  EXPECT_NEAR(clipped.next(limited(8.5, {0, -300, 0})).y(), -Claim::kStep, 0.2);
  EXPECT_TRUE(clipped.held);
}

TEST(Claim, AJumpOfTheProbeAndABadSampleAreComparedWithNothing) {
  for (const uint32_t flag : {HSP_IN_JUMP, HSP_IN_INVALID}) {
    Rested jumped;
    ClaimStep step = at({0, 0, 0}, {0, 8, 0});
    step.in = flag;
    EXPECT_EQ(jumped.next(step), Vector3d(0, 8, 0));
    step.in = 0;
    step.force = {0, -8, 0};
    jumped.next(step);
    EXPECT_EQ(jumped.held, flag == HSP_IN_JUMP) << "what follows a bad sample is the first again";
  }
  Rested forgotten;
  forgotten.claim.forget();
  EXPECT_EQ(forgotten.next(at({0, 0, 0}, {0, 8, 0})), Vector3d(0, 8, 0));
}

ClaimStep traced(double sign, double size = 8) {
  ClaimStep step = at({0, 0, 0}, {0, sign * size, 0});
  step.normal = {0, sign, 0};
  step.out = HSP_OUT_TRACED;
  return step;
}

TEST(Claim, AFootMayGoOverAnEdgeThreeTimesAndThenTwentyTimesASecond) {
  Rested edge;
  int passed = 0;
  for (int i = 0; i < 1000; ++i) {
    ClaimStep step = traced(1);
    step.normal = i % 2 == 0 ? Vector3d::UnitX() : Vector3d::UnitY();
    step.force = 8 * step.normal;
    edge.next(step);
    passed += edge.held ? 0 : 1;
  }
  EXPECT_NEAR(passed, Claim::kPasses + Claim::kPassesPerSecond, 1.1);
  Rested smooth(Vector3d(0, 8, 0));
  smooth.next(traced(1));
  ClaimStep same = traced(1);
  same.force = {0, -8, 0};
  smooth.next(same);
  EXPECT_TRUE(smooth.held) << "its normal is as it was";
  Rested little;
  little.next(traced(1, 0));
  ClaimStep turned = traced(1);
  turned.normal = {std::sin(0.09), std::cos(0.09), 0};
  little.next(turned);
  EXPECT_TRUE(little.held) << "less than an edge of 0.1 rad";
  Rested enough;
  enough.next(traced(1, 0));
  turned.normal = {std::sin(0.11), std::cos(0.11), 0};
  enough.next(turned);
  EXPECT_FALSE(enough.held);
  Rested untraced;
  ClaimStep hidden = traced(1);
  hidden.out = 0;
  untraced.next(hidden);
  EXPECT_TRUE(untraced.held) << "what is not traced has no edges";
}

/// A plate that turns round again and again, at any pace, with a pause or without: it pushed with 8 N for ever at 20
/// turns a second, and for 0.1 s at 50. Each time of its force is counted until three ticks are held back.
TEST(Claim, AForceThatTurnsRoundAgainAndAgainIsHeldBack) {
  for (const int period : {5, 20, 40, 60, 100, 200})  // [ms] from turn to turn
    for (const int pause : {0, 2}) {
      Rested plate;
      int felt = 0, held = 0;
      for (int i = 0; i < 5000 && held < 3; ++i) {
        const bool rests = i % period < pause;
        const Vector3d let = plate.next(traced(i / period % 2 == 0 ? 1 : -1, rests ? 0 : 8));
        felt += let.norm() > Claim::kStep + 0.5 ? 1 : 0;
        held += plate.held ? 1 : 0;
      }
      EXPECT_EQ(held, 3) << period << " ms, pause " << pause;
      // the first push, the turns in a row, and those that the time until then allows
      const double turns = (1 + Claim::kTurns) / (1 - 1e-3 * period * Claim::kTurnsPerSecond);
      EXPECT_LE(felt, period * (turns + 1)) << period << " ms, pause " << pause;
    }
}

/// A hand that presses slowly through a stiff thin plate, and back, is no plate that turns round by itself.
TEST(Claim, AHandMayGoThroughAThinPlateAndBack) {
  Rested plate;
  for (int i = 0; i < 4000; ++i) {
    plate.next(traced(i / 400 % 2 == 0 ? 1 : -1, 6));
    ASSERT_FALSE(plate.held) << i;
  }
}

/// The search finds the surface some ticks after the probe jumped: the force that then comes is not the plugin's jump.
TEST(Claim, ASurfaceThatIsFoundAnewAfterAJumpBlamesNobody) {
  for (const uint32_t flag : {HSP_IN_JUMP, HSP_IN_INVALID}) {
    for (const bool former : {false, true}) {
      Rested found(Vector3d(0, 1, 0));
      found.next(traced(1, 1));
      ClaimStep jump = traced(1, 0);
      jump.in = flag;
      jump.former = former;
      found.next(jump);
      for (int i = 0; i < 5; ++i) found.next(traced(1, 0));
      EXPECT_EQ(found.next(traced(1)).y() == 8, !former) << "by a pass, though the normal is as it was";
      EXPECT_EQ(found.claim.excused(), !former);
    }
  }
  Rested hidden;  // without a surface it comes late, and is excused for a tenth of a second
  ClaimStep step = at({0, 0, 0}, {0, 0, 0});
  step.in = HSP_IN_JUMP;
  hidden.next(step);
  int excused = 0;
  for (int i = 0; i < 1000; ++i) {
    hidden.next(at({0, 0, 0}, {0, i % 2 == 0 ? 8.0 : -8.0, 0}));
    ASSERT_TRUE(hidden.held);
    excused += hidden.claim.excused() ? 1 : 0;
  }
  EXPECT_NEAR(excused, Claim::kFindsAnew / kTick, 2);
}

TEST(Claim, WhatPassedIsWhereTheNextStepBegins) {
  Rested edge;
  edge.next(traced(1));
  ASSERT_FALSE(edge.held);
  edge.next(traced(1, 9.9));
  EXPECT_FALSE(edge.held) << "1.9 N more";
  edge.next(traced(1, 14));
  EXPECT_TRUE(edge.held);
}

TEST(Claim, TheForceOfAModelThatTheHostTurnsTurnsWithIt) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  for (const bool itself : {false, true}) {
    ClaimBounds bounds;
    bounds.moves_itself = itself;
    Rested turned({8, 0, 0}, bounds);
    ClaimStep step = at({0, 0, 0}, {0, 8, 0});
    step.turn = &turn;
    const Vector3d let = turned.next(step);
    EXPECT_EQ(turned.held, itself);
    if (itself) {
      EXPECT_NEAR(let.norm(), Claim::kStep + 50 * kTick * 8, 1e-9) << "50 rad/s";
    }
    step.force = {-8, 0, 0};
    turned.next(step);
    EXPECT_EQ(turned.held, itself);
  }
}

/// A pose that is the shape's own word explains no more than a body can do.
TEST(Claim, OfAShapeThatMovesItselfExplainsABodysSpeed) {
  ClaimBounds bounds;
  bounds.stiffness = 1000;
  bounds.moves_itself = true;
  Rested far(Vector3d::Zero(), bounds);
  ClaimStep step = at({0, 0, 0}, {0, 1000, 0});
  step.p_model = {1, 0, 0};
  step.origin = -step.p_model;
  EXPECT_NEAR(far.next(step).y(), Claim::kMargin * 1000 * Claim::kOwnSpeed * kTick + Claim::kStep, 1e-6);
  Rested near(Vector3d::Zero(), bounds);
  step.p_model = {1e-3, 0, 0};
  step.origin = -step.p_model;
  EXPECT_NEAR(near.next(step).y(), Claim::kMargin * 1000 * 1e-3 + Claim::kStep, 1e-6);
  bounds.damping = 20;
  bounds.stiffness = 1e-9;
  Rested fast(Vector3d::Zero(), bounds);
  step.p_model.setZero();
  step.origin.setZero();
  step.force.y() = 5000;
  step.velocity = {0, 400, 0};
  EXPECT_NEAR(fast.next(step).y(), std::max(Claim::kDamping, Claim::kMargin * 20) * Claim::kOwnSpeed + Claim::kStep,
              1e-6);
  Rested rubbed(Vector3d::Zero(), {1e-9, 0, 0, true});
  EXPECT_NEAR(rubbed.next(step).y(), Claim::kDamping * Claim::kOwnSpeed + Claim::kStep, 1e-6);
}

/// Spinning in place turns the surface under the probe by no more than a body's turn, and explains no more.
TEST(Claim, OfAShapeThatSpinsInPlaceExplainsNextToNothing) {
  ClaimBounds bounds;
  bounds.moves_itself = true;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI, Vector3d::UnitX()).toRotationMatrix();
  ClaimStep step = at({0, 2e-3, 0}, {0, 8, 0});
  Rested there(Vector3d::Zero(), bounds);
  there.next(at({0, 2e-3, 0}, {0, 0, 0}));
  step.p_model = {0, -2e-3, 0};
  step.turn = &turn;
  EXPECT_NEAR(there.next(step).y(), Claim::kMargin * Claim::kUnclaimed * Claim::kOwnTurn * kTick * 2e-3 + Claim::kStep,
              1e-6);
}

TEST(Claim, AClickIsNoMotionThatExplainsTheNext) {
  Rested clicks;
  clicks.next(at({0, 0, 0}, {0, Claim::kStep, 0}));
  ASSERT_FALSE(clicks.held);
  const Vector3d let = clicks.next(at({0, 0, 0}, {0, 2 * Claim::kStep, 0}));
  EXPECT_TRUE(clicks.held);
  EXPECT_NEAR(let.y(), Claim::kStep + Claim::kDrift * kTick, 1e-12);
}

TEST(Claim, ALateTickExplainsNoMoreThanWhatWasLetThrough) {
  Rested late;
  EXPECT_NEAR(late.next(at({0, 0, 0}, {0, 50, 0}), 0.05).y(), Claim::kStep, 1e-12);
  EXPECT_NEAR(late.next(at({0, 0, 0}, {0, 50, 0})).y(), 2 * Claim::kStep, 1e-12);
}

TEST(Claim, ATickWithoutTimeExplainsNoSpeed) {
  ClaimBounds bounds;
  bounds.damping = 30;
  Rested still(Vector3d::Zero(), bounds);
  EXPECT_NEAR(still.next(at({1e-4, 0, 0}, {0, 50, 0}), 0).y(), Claim::kMargin * Claim::kUnclaimed * 1e-4 + Claim::kStep,
              1e-9);
}

TEST(Claim, ComparesForcesOfAnArmOfLessThanANewton) {
  Rested weak({0, 0.4, 0});
  EXPECT_EQ(weak.next(limited(0.5, {0, 300, 0})), Vector3d(0, 300, 0));
  EXPECT_FALSE(weak.held);
}

TEST(Claim, AFootThatIsFoundAnewMayPushThoughTheNormalStoodThereAlready) {
  Rested found;
  ClaimStep hidden = traced(1, 0);
  hidden.out = 0;
  found.next(hidden);
  found.next(traced(1));
  EXPECT_FALSE(found.held);
}

TEST(Claim, TheHostTurnsAModelUnlessItsReportSaysOtherwise) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  Rested turned({8, 0, 0});
  ClaimStep step = at({0, 0, 0}, {0, 8, 0});
  step.turn = &turn;
  turned.next(step);
  EXPECT_FALSE(turned.held);
}

TEST(Claim, OfAShapeThatMovesItselfAndRestsExplainsNothing) {
  ClaimBounds bounds;
  bounds.moves_itself = true;
  Rested aside({8, 0, 0}, bounds);
  EXPECT_NEAR(aside.next(at({0, 0, 0}, {0, 8, 0})).norm(), Claim::kStep, 1e-12) << "it did not turn";
  Claim away;
  bool held = false;
  ClaimStep step = at({0, 0, 0}, {0, 0, 0});
  step.origin = {1, 0, 0};
  away.check(step, bounds, 0, held);
  step.force = {0, 1000, 0};
  step.p_model = {1e-3, 0, 0};  // says its pose, though neither the probe nor the origin moved
  EXPECT_NEAR(away.check(step, bounds, kTick, held).y(), Claim::kStep, 1e-12);
}

}  // namespace
}  // namespace hapticd::servo
