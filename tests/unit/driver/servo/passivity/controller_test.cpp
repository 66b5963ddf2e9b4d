#include "servo/passivity/controller.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hapticd::passivity {
namespace {

using Eigen::Vector3d;
constexpr double kPeriod = 1e-3;

/// A mass of 75 g with friction 0.1 N s/m pressed with 2 N on a wall of `stiffness`; the largest swing of the last
/// second.
double swingOf(double stiffness, PassivityController* controller) {
  double x = 1e-4, v = 0, low = 1e9, high = -1e9;
  for (int i = 0; i < 5000; ++i) {
    Vector3d force(x > 0 ? -stiffness * x : 0, 0, 0);
    if (controller != nullptr) force = controller->update({x, 0, 0}, force, kPeriod);
    for (int k = 0; k < 50; ++k) {
      v += (force.x() + 2.0 - 0.1 * v) / 0.075 * kPeriod / 50;
      x += v * kPeriod / 50;
    }
    if (i < 4000) continue;
    low = std::min(low, x), high = std::max(high, x);
  }
  return high - low;
}

TEST(Controller, CalmsAWallTenTimesTooStiff) {
  const double stiffness = 10 * 2 * 0.1 / kPeriod;
  PassivityController controller(0.075 / kPeriod / 2, 0.1);
  const double alone = swingOf(stiffness, nullptr), calmed = swingOf(stiffness, &controller);
  EXPECT_GT(alone, 10e-3);
  EXPECT_LT(calmed, alone / 20);
  EXPECT_GT(controller.dissipated(), 0);
}

TEST(Controller, LeavesASoftWallAlone) {
  PassivityController controller(37.5, 0.1);
  EXPECT_EQ(swingOf(150, nullptr), swingOf(150, &controller));
  EXPECT_EQ(controller.dissipated(), 0);
}

TEST(Controller, DoesNotTakeAPushOfAMovingModelForEnergyFromNowhere) {
  // A model carries the hand along at 0.1 m/s with 3 N: 0.3 W, rightly given.
  PassivityController told(37.5), untold(37.5);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d position(1e-4 * i, 0, 0), force(3, 0, 0);
    const Exchange exchange{i == 0 ? 0 : 3 * 1e-4};
    EXPECT_LT((told.update(position, force, kPeriod, exchange) - force).norm(), 1e-9);
    untold.update(position, force, kPeriod);
  }
  EXPECT_NEAR(told.dissipated(), 0, 1e-12);
  EXPECT_GT(untold.dissipated(), 0.01);
}

TEST(Controller, ForgetsCreditThatNoContactCanGiveBack) {
  // A minute of stroking through a viscous contact pays in joules; the wall holds a millijoule.
  PassivityController capped(37.5), uncapped(37.5);
  double x = 0;
  for (int i = 0; i < 60000; ++i) {
    x += 1e-4;
    capped.update({x, 0, 0}, {-1, 0, 0}, kPeriod, {0, 1e-3});
    uncapped.update({x, 0, 0}, {-1, 0, 0}, kPeriod);
  }
  EXPECT_LE(capped.energy(), 1e-3);
  EXPECT_GT(uncapped.energy(), 5);
  for (int i = 0; i < 100; ++i) {  // now it gives 0.1 mJ a tick away
    x += 1e-4;
    capped.update({x, 0, 0}, {1, 0, 0}, kPeriod, {0, 1e-3});
    uncapped.update({x, 0, 0}, {1, 0, 0}, kPeriod);
  }
  EXPECT_GT(capped.dissipated(), 0);
  EXPECT_EQ(uncapped.dissipated(), 0) << "the old credit hides it";
}

TEST(Controller, BooksWhatTheLimitsLeftOfTheForce) {
  PassivityController controller(37.5);
  for (int i = 0; i < 100; ++i) {
    controller.update({-1e-5 * i, 0, 0}, {10, 0, 0}, kPeriod);
    controller.applied({1, 0, 0});
  }
  EXPECT_NEAR(controller.energy(), 1 * 99e-5, 1e-12);
}

TEST(Controller, SurvivesNonsense) {
  PassivityController controller(37.5);
  const double nan = std::nan("");
  for (int i = 0; i < 100; ++i) {
    const Vector3d position(i % 7 == 3 ? nan : 1e-5 * i, 0, 0), force(i % 5 == 2 ? nan : 1, 0, 0);
    EXPECT_TRUE(controller.update(position, force, i % 11 == 5 ? nan : kPeriod, {nan, nan}).allFinite());
    controller.applied({i % 13 == 1 ? nan : 1, 0, 0});
  }
  EXPECT_TRUE(std::isfinite(controller.energy()));
}

}  // namespace
}  // namespace hapticd::passivity
