// SPDX-License-Identifier: MIT
#include "kernels/medial/energy_account.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::medial {
namespace {

/// A spring that is met in ticks, with the account that guards it.
struct Guarded {
  double force(double stiffness, double depth) {
    const double whole = stiffness * depth, moved = depth - depth_;
    account.add(.5 * last_ * moved);
    share = account.share(.5 * whole * moved, .5 * whole * depth, 0);
    got -= .5 * (last_ + share * whole) * moved;
    last_ = share * whole, depth_ = depth;
    return last_;
  }
  EnergyAccount account;
  double share = 1, got = 0;  ///< got: [J] work on the hand

 private:
  double last_ = 0, depth_ = 0;
};

TEST(EnergyAccount, AStraightPressFeelsTheWholeSpring) {
  Guarded spring;
  for (int i = 1; i <= 100; ++i) {
    EXPECT_NEAR(spring.force(200, 4e-5 * i), 200 * 4e-5 * i, 1e-15);
    EXPECT_EQ(spring.share, 1);
  }
  for (int i = 99; i >= 0; --i) EXPECT_NEAR(spring.force(200, 4e-5 * i), 200 * 4e-5 * i, 1e-15);
  EXPECT_NEAR(spring.got, 0, 1e-12);
}

/// In where it is soft, out where it is four times as stiff.
TEST(EnergyAccount, ASpringThatGrowsStifferGivesBackWhatItGot) {
  Guarded spring;
  for (int i = 1; i <= 100; ++i) spring.force(200, 4e-5 * i);
  const double put_in = -spring.got;
  for (int i = 0; i <= 100; ++i) spring.force(200 + 6 * i, .004);
  EXPECT_NEAR(spring.share, .25 * 1.5, .01);
  for (int i = 99; i >= 0; --i) spring.force(800, 4e-5 * i);
  EXPECT_LT(spring.got, .001 * put_in);
  EXPECT_GT(spring.got, -.1 * put_in);
}

/// The force follows the stiffness without a step, there and back.
TEST(EnergyAccount, TheShareChangesAsTheStiffnessDoes) {
  Guarded spring;
  for (int i = 1; i <= 100; ++i) spring.force(200, 4e-5 * i);
  double before = spring.force(200, .004);
  for (int i = 0; i <= 1000; ++i) {
    const double now = spring.force(200 + 300 * (1 - std::cos(2 * M_PI * i / 1000)), .004);
    EXPECT_NEAR(now, before, .006);
    before = now;
  }
  EXPECT_EQ(spring.share, 1);
}

/// What was missing near the surface is little of a deep press.
TEST(EnergyAccount, AContactForgetsWhatWasMissingNearTheSurface) {
  Guarded spring;
  for (int i = 1; i <= 10; ++i) spring.force(20, 4e-5 * i);
  spring.force(200, 4e-4);
  EXPECT_LT(spring.share, .2);
  for (int i = 11; i <= 100; ++i) spring.force(200, 4e-5 * i);
  EXPECT_EQ(spring.share, 1);
  for (int i = 99; i >= 0; --i) spring.force(200, 4e-5 * i);
  EXPECT_LT(spring.got, 1e-6);
}

/// What a hand did not put in is forgiven, without a step: it feels the place where it rests.
TEST(EnergyAccount, ForgivesWhatIsMissing) {
  constexpr double kEnergy = .05;
  for (const double dt : {1e-4, 1e-3, 1e-2}) {  // in the same time at every rate
    EnergyAccount account;
    double before = account.share(0, kEnergy, 0), t = 0;
    EXPECT_EQ(before, 0);
    for (; before < 1; t += dt) {
      const double now = account.share(0, kEnergy, dt);
      EXPECT_GT(now, before);
      EXPECT_LT(now - before, 4 * dt);
      before = now;
    }
    EXPECT_NEAR(t, EnergyAccount::kForgivesIn * std::log(3), .02);
  }
}

TEST(EnergyAccount, KeepsNoMoreThanIsStored) {
  EnergyAccount account;
  account.add(3);
  account.keep(2);
  EXPECT_EQ(account.held(), 2);
  account.add(-5);
  account.keep(2);
  EXPECT_EQ(account.held(), 0);
  account.add(std::nan(""));
  account.keep(2);
  EXPECT_EQ(account.held(), 0);
  EXPECT_EQ(account.share(0, 1, 0), 0);
}

}  // namespace
}  // namespace hapticd::medial
