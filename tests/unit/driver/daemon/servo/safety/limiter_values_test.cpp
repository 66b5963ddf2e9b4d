// SPDX-License-Identifier: MIT
/// Tests the numbers of the limiter where a single wrong operator or constant changes them. tests/mutation showed that
/// no other test noticed these changes.
#include <gtest/gtest.h>

#include <limits>

#include "limiter_rig.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;

struct Applied {
  Vector3d force, torque;
};

Applied applied(Limiter& limiter, const Vector3d& force, const Vector3d& torque = Vector3d::Zero(),
                const Vector3d& position = Vector3d::Zero()) {
  Applied out{force, torque};
  limiter.apply(out.force, out.torque, position, kTick);
  return out;
}

TEST(Limiter, FadesOverTwoCentimetresBeyondTheWorkspace) {
  scene::Limits limits = generous();
  limits.workspace = 0.1;
  for (const auto& [distance, share] :
       {std::pair{0.05, 1.0}, {0.1, 1.0}, {0.11, 0.5}, {0.115, 0.25}, {0.12, 0.0}, {0.2, 0.0}}) {
    Limiter limiter(limits, 8.5);
    EXPECT_NEAR(applied(limiter, {4, 0, 0}, Vector3d::Zero(), {0, distance, 0}).force.x(), 4 * share, 1e-9) << distance;
    EXPECT_EQ(limiter.clips().ticks[static_cast<size_t>(Limit::kWorkspace)], share < 1 ? 1u : 0u) << distance;
  }
}

/// What follows the force goes on where the limit is below one newton per second, too.
TEST(Limiter, LetsAForceGrowToItsEndHoweverSlowTheLimit) {
  scene::Limits limits = generous();
  limits.slew = limits.torque_slew = 0.5;
  Limiter slow(limits, 8.5);
  Applied last;
  for (int i = 0; i < 300; ++i) last = applied(slow, {0, 0.1, 0}, {0, 0.05, 0});
  EXPECT_NEAR(last.force.y(), 0.1, 1e-12) << "after 0.2 s";
  EXPECT_NEAR(last.torque.y(), 0.05, 1e-12);
}

TEST(Limiter, BoundsTheTorqueAndItsGrowth) {
  scene::Limits limits = generous();
  limits.torque = 0.2;
  Limiter capped(limits, 8.5);
  EXPECT_NEAR(applied(capped, Vector3d::Zero(), {0, 0.5, 0}).torque.y(), 0.2, 1e-12);
  EXPECT_EQ(capped.clips().ticks[static_cast<size_t>(Limit::kTorque)], 1u);
  EXPECT_NEAR(applied(capped, Vector3d::Zero(), {0, 0.1, 0}).torque.y(), 0.1, 1e-12);
  EXPECT_EQ(capped.clips().ticks[static_cast<size_t>(Limit::kTorque)], 1u) << "it did not bind";
  limits.torque = 0;
  limits.torque_slew = 0.5;
  Limiter slow(limits, 8.5);
  EXPECT_NEAR(applied(slow, Vector3d::Zero(), {0, 0.1, 0}).torque.y(), 0.5 * kTick, 1e-12);
  EXPECT_NEAR(applied(slow, Vector3d::Zero(), {0, 0.1, 0}).torque.y(), 2 * 0.5 * kTick, 1e-12);
}

TEST(Limiter, RecoversOnlyFromWhatEndsByItself) {
  for (const Fault fault : {Fault::kTooFast, Fault::kStopped, Fault::kNotFinite, Fault::kDeviceLost, Fault::kStale}) {
    Limiter limiter(generous(), 8.5);
    applied(limiter, {4, 0, 0});
    limiter.trip(fault);
    while (!limiter.silent()) applied(limiter, {4, 0, 0});
    limiter.recover();
    EXPECT_EQ(limiter.fault() == Fault::kNone, endsByItself(fault)) << static_cast<int>(fault);
    EXPECT_EQ(limiter.recovered(), endsByItself(fault) ? fault : Fault::kNone);
  }
}

TEST(Limiter, SaysWhatTheRampsLetFlow) {
  scene::Limits limits = generous();
  limits.ramp_in = 0.1;
  limits.ramp_out = 0.02;
  Limiter limiter(limits, 8.5);
  for (int i = 0; i < 50; ++i) applied(limiter, {4, 0, 0});
  EXPECT_NEAR(limiter.allowed(), 0.5, 1e-9);
  limiter.trip(Fault::kStopped);
  for (int i = 0; i < 10; ++i) applied(limiter, {4, 0, 0});
  EXPECT_NEAR(limiter.allowed(), 0.25, 1e-9);
}

TEST(Limiter, RampsTheTorqueWithTheForce) {
  scene::Limits limits = generous();
  limits.ramp_in = 0.1;
  Limiter ramped(limits, 8.5);
  for (int i = 0; i < 49; ++i) applied(ramped, {4, 0, 0}, {0, 0.2, 0});
  EXPECT_NEAR(applied(ramped, {4, 0, 0}, {0, 0.2, 0}).torque.y(), 0.1, 1e-9);
  Limiter aged(generous(), 8.5);
  aged.trustSample(0.25);
  const Applied out = applied(aged, {4, 0, 0}, {0, 0.2, 0});
  EXPECT_NEAR(out.force.x(), 1, 1e-12);
  EXPECT_NEAR(out.torque.y(), 0.05, 1e-12);
}

TEST(Limiter, OneNumberThatIsNoneIsAFault) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int which = 0; which < 3; ++which) {
    Limiter limiter(generous(), 8.5);
    const Vector3d good(1, 0, 0), bad(1, nan, 0);
    const Applied out = applied(limiter, which == 0 ? bad : good, which == 1 ? bad : good, which == 2 ? bad : good);
    EXPECT_EQ(limiter.fault(), Fault::kNotFinite) << which;
    EXPECT_TRUE(out.force.isZero(0) && out.torque.isZero(0)) << which;
  }
}

TEST(Limiter, HoldsAForceThatTheImpulseLimitAllowsForEver) {
  scene::Limits limits = generous();
  limits.impulse = 1;  // a constant force ends at five times that
  Limiter weak(limits, 8.5), strong(limits, 8.5);
  const auto cuts = [](const Limiter& l) { return l.clips().ticks[static_cast<size_t>(Limit::kImpulse)]; };
  for (int i = 0; i < 5000; ++i) {
    EXPECT_EQ(applied(weak, {4, 0, 0}).force.x(), 4);
    applied(strong, {8, 0, 0});
  }
  EXPECT_EQ(cuts(weak), 0u);
  EXPECT_GT(cuts(strong), 4000u);
  EXPECT_NEAR(applied(strong, {8, 0, 0}).force.x(), 5, 0.05);
}

TEST(Limiter, ForgetsThePushesOfASecondAgo) {
  scene::Limits limits = generous();
  limits.impulse = 0.2;
  Limiter limiter(limits, 0);
  for (int push = 0; push < 3; ++push) {
    EXPECT_EQ(applied(limiter, {8, 0, 0}).force.x(), 8) << push;
    for (int i = 0; i < 20; ++i) applied(limiter, {8, 0, 0});
    EXPECT_LT(applied(limiter, {8, 0, 0}).force.x(), 7) << push;
    for (int i = 0; i < 1000; ++i) applied(limiter, Vector3d::Zero());
  }
}

TEST(Limiter, ASpeedAtItsLimitIsNoFault) {
  scene::Limits limits = generous();
  limits.velocity = 3;
  Limiter limiter(limits, 8.5);
  limiter.watchSpeed(3);
  EXPECT_EQ(limiter.fault(), Fault::kNone);
  limiter.watchSpeed(3.0001);
  EXPECT_EQ(limiter.fault(), Fault::kTooFast);
}

TEST(Limiter, TheFilesLimitHoldsWhereTheDeviceNamesNone) {
  for (const double most : {0.5, 5.0}) {
    scene::Limits limits = generous();
    limits.force = most;
    Limiter limiter(limits, 0);
    EXPECT_NEAR(applied(limiter, {8, 0, 0}).force.x(), most, 1e-12);
  }
}

TEST(Limiter, WithoutALimitOfPowerSpeedTakesNothing) {
  Limiter limiter(generous(), 8.5);
  limiter.watchVelocity({2, 0, 0});
  EXPECT_EQ(applied(limiter, {4, 0, 0}).force.x(), 4);
}

TEST(Limiter, ALetGoSwitchTakesTheForceAwayWithinTwoMilliseconds) {
  for (const double ramp_out : {0.5, 0.02, 0.0005}) {
    scene::Limits limits = generous();
    limits.ramp_out = ramp_out;
    limits.enable.button = 0;
    limits.enable.mode = scene::EnableMode::kHold;
    Limiter limiter(limits, 8.5);
    limiter.watchButtons(0);
    limiter.watchButtons(1);
    EXPECT_EQ(applied(limiter, {4, 0, 0}).force.x(), 4);
    limiter.watchButtons(0);
    EXPECT_NEAR(applied(limiter, {4, 0, 0}).force.x(), ramp_out < kTick ? 0 : 2, 1e-9) << ramp_out;
    EXPECT_EQ(applied(limiter, {4, 0, 0}).force.x(), 0) << ramp_out;
  }
}

TEST(Limiter, SlewMayBeLessThanANewtonASecond) {
  scene::Limits limits = generous();
  limits.slew = 0.5;
  Limiter limiter(limits, 8.5);
  EXPECT_NEAR(applied(limiter, {4, 0, 0}).force.x(), 0.5 * kTick, 1e-12);
  limits.slew = 0;
  limits.torque_slew = 0.5;
  Limiter turned(limits, 8.5);
  EXPECT_NEAR(applied(turned, {4, 0, 0}, {0.1, 0, 0}).torque.x(), 0.5 * kTick, 1e-12);
}

TEST(Limiter, CountsWhatTookAwaySomethingAndNothingElse) {
  const auto count = [](const Limiter& l, Limit which) { return l.clips().ticks[static_cast<size_t>(which)]; };
  Limiter aged(generous(), 8.5);
  aged.trustSample(0.5);
  applied(aged, {0.5, 0, 0});
  EXPECT_EQ(count(aged, Limit::kSample), 1u);
  applied(aged, Vector3d::Zero(), {0.5, 0, 0});
  EXPECT_EQ(count(aged, Limit::kSample), 2u);
  applied(aged, Vector3d::Zero());
  EXPECT_EQ(count(aged, Limit::kSample), 2u) << "there was nothing to take";
  scene::Limits limits = generous();
  limits.workspace = 0.1;
  Limiter far(limits, 8.5);
  far.spareMotors(0.5);
  applied(far, Vector3d::Zero(), Vector3d::Zero(), {1, 0, 0});
  EXPECT_EQ(far.clips().any, 0u);
  applied(far, Vector3d::Zero(), {0.1, 0, 0}, {1, 0, 0});
  EXPECT_EQ(count(far, Limit::kWorkspace), 1u);
  EXPECT_EQ(count(far, Limit::kHeat), 1u);
  EXPECT_EQ(far.clips().any, 1u) << "ticks, not limits";
  Limiter first(generous(), 8.5);
  first.clippedByMotors();
  EXPECT_EQ(first.clips().any, 1u) << "in the first tick too";
}

/// A force that grows more slowly than limits.slew lets it is not counted as cut.
TEST(Limiter, CountsNoSlewOfAForceThatGrowsSlowly) {
  scene::Limits limits = generous();
  limits.slew = 1000;
  limits.torque_slew = 100;
  Limiter limiter(limits, 8.5);
  for (int i = 1; i <= 5; ++i) EXPECT_EQ(applied(limiter, {0.5 * i, 0, 0}, {0, 0.05 * i, 0}).force.x(), 0.5 * i);
  EXPECT_EQ(limiter.clips().any, 0u);
}

TEST(Limiter, PowerBoundsAForceBelowANewtonToo) {
  scene::Limits limits = generous();
  limits.power = 0.1;
  Limiter limiter(limits, 8.5);
  limiter.watchVelocity({1, 0, 0});
  EXPECT_NEAR(applied(limiter, {0.8, 0, 0}).force.x(), 0.1, 1e-12);
}

TEST(Limiter, AClearBeginsTheRampAnew) {
  scene::Limits limits = generous();
  limits.ramp_in = 0.1;
  Limiter limiter(limits, 8.5);
  EXPECT_EQ(limiter.measured(), 0);
  for (int i = 0; i < 50; ++i) applied(limiter, {4, 0, 0});
  limiter.clear();
  EXPECT_EQ(limiter.allowed(), 0);
  EXPECT_NEAR(applied(limiter, {4, 0, 0}).force.x(), 0.04, 1e-9);
}

TEST(Limiter, ATorqueGrowsNoFasterThanItsDefaultSlew) {
  scene::Limits limits;
  limits.ramp_in = 0;
  Limiter limiter(limits, 8.5);
  double last = 0;
  for (int i = 0; i < 20; ++i) {
    Vector3d force = Vector3d::Zero(), torque(0, 5, 0);
    limiter.apply(force, torque, Vector3d::Zero(), kTick);
    EXPECT_NEAR(torque.y() - last, 0.2, 1e-9) << "2000 N/s at 0.1 m, in a millisecond";
    last = torque.y();
  }
}

}  // namespace
}  // namespace hapticd::servo
