#include "servo/limiter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

scene::Limits generous() {
  scene::Limits limits;
  limits.ramp_in = 0;
  limits.slew = 0;
  return limits;
}

Vector3d limited(Limiter& limiter, Vector3d force, double dt = 1e-3) {
  Vector3d torque = Vector3d::Zero();
  limiter.apply(force, torque, Vector3d::Zero(), dt);
  return force;
}

TEST(Limiter, RampsInFromZero) {
  scene::Limits limits;
  limits.slew = 0;
  limits.ramp_in = 0.1;
  Limiter limiter(limits, 8.5);
  double last = 0;
  for (int i = 0; i < 100; ++i) {
    const double force = limited(limiter, {4, 0, 0}).x();
    EXPECT_LE(force - last, 4.0 / 100 + 1e-12);
    last = force;
  }
  EXPECT_NEAR(last, 4, 1e-9);
}

TEST(Limiter, KeepsTheDirectionWhenItCutsTheForce) {
  Limiter limiter(generous(), 8.5);
  const Vector3d force = limited(limiter, {30, 40, 0});
  EXPECT_NEAR(force.norm(), 8.5, 1e-12);
  EXPECT_NEAR(force.y() / force.x(), 4.0 / 3.0, 1e-12);
}

TEST(Limiter, TheDeviceMaximumHoldsWhateverTheFileAllows) {
  scene::Limits limits = generous();
  limits.force = 100;
  Limiter limiter(limits, 8.5);
  EXPECT_NEAR(limited(limiter, {50, 0, 0}).norm(), 8.5, 1e-12);
}

TEST(Limiter, NeverChangesFasterThanTheSlewLimit) {
  scene::Limits limits = generous();
  limits.slew = 500;
  Limiter limiter(limits, 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-10, 10);
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 10000; ++i) {
    const Vector3d force = limited(limiter, {any(random), any(random), any(random)});
    EXPECT_LE((force - last).norm(), 0.5 + 1e-12);
    last = force;
  }
}

TEST(Limiter, AnyFaultEndsInZeroForceWithinTwentyMillisecondsAndNeverRaisesIt) {
  for (int fault = 1; fault <= static_cast<int>(Fault::kStopped); ++fault) {
    Limiter limiter(generous(), 8.5);
    limited(limiter, {5, -3, 1});
    limiter.trip(static_cast<Fault>(fault));
    double last = Vector3d(5, -3, 1).norm();
    for (int i = 0; i < 20; ++i) {
      const double force = limited(limiter, {8, 8, 8}).norm();
      EXPECT_LE(force, last);
      last = force;
    }
    EXPECT_EQ(last, 0) << describe(static_cast<Fault>(fault));
    EXPECT_TRUE(limiter.silent());
    EXPECT_EQ(limited(limiter, {8, 8, 8}).norm(), 0) << "a fault latches";
  }
}

TEST(Limiter, NotANumberTripsAndIsNeverPassedOn) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Limiter limiter(generous(), 8.5);
    limited(limiter, {2, 0, 0});
    const Vector3d force = limited(limiter, {bad, 0, 0});
    EXPECT_TRUE(force.allFinite());
    EXPECT_LE(force.norm(), 2);
    EXPECT_EQ(limiter.fault(), Fault::kNotFinite);
  }
}

TEST(Limiter, KeepsTheFirstFaultUntilTheUserClearsIt) {
  Limiter limiter(generous(), 8.5);
  limiter.trip(Fault::kDeviceLost);
  limiter.trip(Fault::kStale);
  EXPECT_EQ(limiter.fault(), Fault::kDeviceLost);
  limiter.clear();
  EXPECT_EQ(limiter.fault(), Fault::kNone);
  EXPECT_GT(limited(limiter, {1, 0, 0}).norm(), 0);
}

TEST(Limiter, SpeedThatIsNotANumberIsTooFast) {
  scene::Limits limits = generous();
  limits.velocity = 3;
  Limiter limiter(limits, 8.5);
  limiter.watchSpeed(2.9);
  EXPECT_EQ(limiter.fault(), Fault::kNone);
  limiter.watchSpeed(std::nan(""));
  EXPECT_EQ(limiter.fault(), Fault::kTooFast);
}

}  // namespace
}  // namespace hapticd::servo
