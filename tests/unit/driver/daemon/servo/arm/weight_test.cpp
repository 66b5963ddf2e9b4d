// SPDX-License-Identifier: MIT
#include "servo/arm/weight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace hapticd::servo {
namespace {

/// Carries torques of 1, 2 and 3 N m of an arm with levers of 1 m, in ticks of 1 ms; ramps of 0.5 s in, 0.1 s out.
struct Carried {
  explicit Carried(std::optional<double> most = {}) : weight(limitsOf(most), 0) {}
  static scene::Limits limitsOf(std::optional<double> most) {
    scene::Limits limits;
    limits.ramp_in = 0.5, limits.ramp_out = 0.1;
    limits.weight = most;
    return limits;
  }
  /// Returns the last share of the torques after some ticks, and keeps the largest change of it in a tick.
  double after(int ticks, double allowed = 1) {
    for (int i = 0; i < ticks; ++i) {
      Weight::Torques torques{1, 2, 3};
      weight.bound(torques, TipJacobian::Identity(3, 3), allowed, 1e-3);
      EXPECT_NEAR(torques[1], 2 * torques[0], 1e-12);
      EXPECT_NEAR(torques[2], 3 * torques[0], 1e-12);
      steepest = std::max(steepest, std::abs(torques[0] - share));
      share = torques[0];
    }
    return share;
  }
  Weight weight;
  double share = 0, steepest = 0;
};

TEST(Weight, ComesAndGoesInARamp) {
  Carried arm;
  EXPECT_EQ(arm.after(10), 0) << "nobody wants it";
  arm.weight.carry(true);
  EXPECT_NEAR(arm.after(250), 0.5, 1e-9);
  EXPECT_NEAR(arm.after(300), 1, 1e-9);
  EXPECT_LT(arm.steepest, 1.001e-3 / 0.5);
  arm.steepest = 0;
  arm.weight.carry(false);
  EXPECT_NEAR(arm.after(50), 0.5, 1e-9);
  EXPECT_EQ(arm.after(100), 0);
  EXPECT_LT(arm.steepest, 1.001e-3 / 0.1);
}

TEST(Weight, IsNeverMoreThanAFaultLeaves) {
  Carried arm;
  arm.weight.carry(true);
  arm.after(1000);
  EXPECT_NEAR(arm.after(1, 0.25), 0.25, 1e-12);
  EXPECT_EQ(arm.after(1, 0), 0);
}

TEST(Weight, IsBoundedByTheForceThatItIsAtTheTip) {
  Carried arm(0.1);
  arm.weight.carry(true);
  EXPECT_NEAR(arm.after(1000), 0.1 / std::sqrt(14.0), 1e-9) << "levers of 1 m: 1, 2 and 3 N m are 14^(1/2) N";
}

}  // namespace
}  // namespace hapticd::servo
