// SPDX-License-Identifier: MIT
/// The torque of a shape is held to its claim as its force is, at the length of a handle.
#include <Eigen/Geometry>

#include "claim_rig.hpp"

namespace hapticd::servo {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
constexpr double kClick = Claim::kStep * Claim::kHandle;  ///< [N m] that a torque may stand from what is explained

ClaimStep twist(const Vector3d& torque) {
  ClaimStep step = at(Vector3d::Zero(), Vector3d::Zero());
  step.torque = torque;
  return step;
}

/// A probe at rest, with a torque of its own.
struct Twisted {
  explicit Twisted(const Vector3d& torque = Vector3d::Zero(), ClaimBounds given = {}) : bounds(given) {
    next(twist(torque));
    EXPECT_FALSE(held) << "the first is compared with nothing";
  }
  Vector3d next(const ClaimStep& step, double dt = kTick) {
    const Vector3d let = claim.checkTorque(step, bounds, dt, held);
    claim.check(step, bounds, dt, force_held);
    return let;
  }
  ClaimBounds bounds;
  Claim claim;
  bool held = false, force_held = false;
};

TEST(Claim, ATorqueMayClickAndNotKick) {
  Twisted click;
  EXPECT_EQ(click.next(twist({kClick, 0, 0})), Vector3d(kClick, 0, 0));
  EXPECT_FALSE(click.held);
  Twisted kick;
  EXPECT_NEAR((kick.next(twist({0, 2, 0})) - Vector3d(0, 0.2, 0)).norm(), 0, 1e-12) << "2 N at 0.1 m";
  EXPECT_TRUE(kick.held);
  EXPECT_FALSE(kick.force_held);
  EXPECT_FALSE(kick.claim.excused());
}

TEST(Claim, ATorqueMayAlwaysShrinkAndNeverTurnRound) {
  Twisted shrinks({0, 3, 0});
  for (const double part : {0.9, 0.4, 0.0}) {
    EXPECT_EQ(shrinks.next(twist({0, 3 * part, 0})), Vector3d(0, 3 * part, 0));
    EXPECT_FALSE(shrinks.held);
  }
  Twisted turns({0, 3, 0});
  EXPECT_NEAR((turns.next(twist({0, -3, 0})) - Vector3d(0, -kClick, 0)).norm(), 0, 1e-12);
  EXPECT_TRUE(turns.held);
  Twisted aside({0, 3, 0});
  EXPECT_NEAR(aside.next(twist({3, 0, 0})).norm(), kClick, 1e-12) << "as a vector, not by its length";
}

TEST(Claim, ATorqueMayDriftSlowlyAndAVibrationStaysBounded) {
  Twisted drifts;
  for (int i = 1; i <= 1000; ++i) {
    drifts.next(twist({0.5 * Claim::kDrift * Claim::kHandle * kTick * i, 0, 0}));
    ASSERT_FALSE(drifts.held) << i;
  }
  Twisted fast;
  double last = 0;
  for (int i = 1; i <= 100; ++i) last = fast.next(twist({2 * Claim::kDrift * Claim::kHandle * kTick * i, 0, 0})).x();
  EXPECT_TRUE(fast.held);
  EXPECT_LE(last, kClick + Claim::kDrift * Claim::kHandle * kTick * 100 + 1e-9);
  Twisted shakes;
  double most = 0;
  for (int i = 0; i < 500; ++i) most = std::max(most, shakes.next(twist({0, 0, i % 2 == 0 ? 1.0 : -1.0})).norm());
  EXPECT_LE(most, kClick + 2 * Claim::kDrift * Claim::kHandle * kTick + 1e-9);
}

TEST(Claim, AJumpThatIsReportedIsOneOfTheTorqueToo) {
  ClaimBounds bounds;
  bounds.jump = 5;
  Twisted snaps(Vector3d::Zero(), bounds);
  EXPECT_NEAR(snaps.next(twist({9, 0, 0})).x(), 0.5, 1e-12);
}

TEST(Claim, TheWayOfTheProbeExplainsATorque) {
  ClaimBounds bounds;
  bounds.stiffness = 1000;
  Twisted moved(Vector3d::Zero(), bounds);
  ClaimStep step = twist({9, 0, 0});
  step.p_world = step.p_model = {0, 0, 1e-3};
  EXPECT_NEAR(moved.next(step).x(), Claim::kMargin * 1000 * 1e-3 * Claim::kHandle + kClick, 1e-9);
}

TEST(Claim, TheTurnOfTheProbeExplainsATorque) {
  for (const double angle : {0.01, 0.1, 3.0}) {
    Twisted turned;
    ClaimStep step = twist({1e4, 0, 0});
    step.orientation = Quaterniond(AngleAxisd(angle, Vector3d(1, 2, -2) / 3)).coeffs();
    const double explained = Claim::kMargin * Claim::kUnclaimed * Claim::kHandle * Claim::kHandle * angle;
    const double let = turned.next(step).x();
    EXPECT_GE(let, explained + kClick) << angle;
    EXPECT_LE(let, 1.2 * explained + kClick) << angle;
    ClaimStep same = step;
    same.orientation *= -1;
    same.torque *= -1;
    EXPECT_NEAR(turned.next(same).x(), -kClick, 1e-9) << "the other quaternion is the same turn";
  }
  ClaimBounds damped;
  damped.damping = 40;
  damped.stiffness = 1e-9;
  Twisted rubbed(Vector3d::Zero(), damped);
  ClaimStep step = twist({1e4, 0, 0});
  step.orientation = Quaterniond(AngleAxisd(0.01, Vector3d::UnitX())).coeffs();
  const double explained = Claim::kMargin * 40 * Claim::kHandle * Claim::kHandle * 10;  // rad/s
  EXPECT_NEAR(rubbed.next(step).x(), explained + kClick, 0.2 * explained);
  Twisted at_once(Vector3d::Zero(), damped);
  EXPECT_NEAR(at_once.next(step, 0).x(), kClick, 1e-6) << "no time: no speed";
}

TEST(Claim, TheTorqueOfAModelThatTheHostTurnsTurnsWithIt) {
  const Matrix3d turn = AngleAxisd(1e-3, Vector3d::UnitZ()).toRotationMatrix();
  for (const bool itself : {false, true}) {
    ClaimBounds bounds;
    bounds.moves_itself = itself;
    bounds.stiffness = 1e-9;
    Twisted turned({1000, 0, 0}, bounds);
    ClaimStep step = twist(turn * Vector3d(1000, 0, 0));
    step.turn = &turn;
    turned.next(step);
    EXPECT_FALSE(turned.held) << "1 N m of it is aside";
    step.torque = {1000, 0, 0};
    turned.next(step);
    EXPECT_EQ(turned.held, !itself) << "where the host turns it, a torque that does not turn along is a change";
  }
}

TEST(Claim, TheTurnOfAModelExplainsATorqueOnlyWhereTheHostTurnsIt) {
  const Matrix3d turn = AngleAxisd(0.2, Vector3d::UnitZ()).toRotationMatrix();
  for (const bool itself : {false, true}) {
    ClaimBounds bounds;
    bounds.moves_itself = itself;
    Twisted turned(Vector3d::Zero(), bounds);
    ClaimStep step = twist({1e4, 0, 0});
    step.turn = &turn;
    const double explained = Claim::kMargin * Claim::kUnclaimed * Claim::kHandle * Claim::kHandle * 0.2;
    EXPECT_NEAR(turned.next(step).x(), (itself ? 0 : explained) + kClick, itself ? 1e-9 : 0.2 * explained);
  }
}

TEST(Claim, AFootThatGoesOverAnEdgeTakesOnePassForForceAndTorque) {
  Twisted edge;
  int passed = 0;
  for (int i = 0; i < 8; ++i) {
    ClaimStep step = at(Vector3d::Zero(), {0, i % 2 == 0 ? 8.0 : -8.0, 0});
    step.torque = {i % 2 == 0 ? 1.0 : -1.0, 0, 0};
    step.normal = {0, i % 2 == 0 ? 1.0 : -1.0, 0};
    step.out = HSP_OUT_TRACED;
    edge.next(step);
    EXPECT_EQ(edge.held, edge.force_held) << i;
    passed += edge.held ? 0 : 1;
  }
  EXPECT_EQ(passed, static_cast<int>(Claim::kPasses));
}

TEST(Claim, ATorqueAfterAJumpOrABadSampleIsComparedWithNothing) {
  for (const uint32_t flag : {HSP_IN_JUMP, HSP_IN_INVALID}) {
    Twisted jumped;
    ClaimStep step = twist({5, 0, 0});
    step.in = flag;
    EXPECT_EQ(jumped.next(step), Vector3d(5, 0, 0));
    step = twist({-5, 0, 0});
    jumped.next(step);
    EXPECT_EQ(jumped.held, flag == HSP_IN_JUMP) << "what follows a bad sample is the first again";
  }
  Twisted forgotten;
  forgotten.claim.forget();
  EXPECT_EQ(forgotten.next(twist({5, 0, 0})), Vector3d(5, 0, 0));
}

TEST(Claim, ComparesTorquesOnlyAsFarAsTheArmLetsThem) {
  const auto bounded = [](double torque) {
    ClaimStep step = twist({torque, 0, 0});
    step.max_torque = 0.5;
    return step;
  };
  Twisted clipped({0.45, 0, 0});
  EXPECT_EQ(clipped.next(bounded(300)), Vector3d(300, 0, 0)) << "the limit cuts it to 0.5 N m";
  EXPECT_FALSE(clipped.held);
  EXPECT_NEAR(clipped.next(bounded(-300)).x(), -kClick, 0.02);
  EXPECT_TRUE(clipped.held);
}

}  // namespace
}  // namespace hapticd::servo
