// SPDX-License-Identifier: MIT
#include "kernels/dynamics/button.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace hapticd::dynamics {
namespace {

TEST(Button, SnapsWithHysteresisAndReportsEachClickOnce) {
  const DetentCurve::Knot knots[] = {{0, 0}, {0.003, 6}, {0.004, 2}};
  const DetentCurve detent(knots, 8000);
  ButtonState button;
  int clicks = 0;
  double in = 0, out = 0;
  const auto at = [](int i) { return 8e-3 * i / 8000; };
  for (int i = 0; i <= 8000; ++i)
    if (button.step(2000, detent, at(i)).clicked) ++clicks, in = at(i);
  for (int i = 8000; i >= 0; --i)
    if (button.step(2000, detent, at(i)).clicked) ++clicks, out = at(i);
  EXPECT_EQ(clicks, 2);
  EXPECT_NEAR(in, 0.003 + 6.0 / 2000, 2e-6);
  EXPECT_NEAR(out, 0.004 + 2.0 / 2000, 2e-6);
}

TEST(Button, EveryEquilibriumBalancesBothSpringsAndSharesTheTravel) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> travel_of(2e-4, 1.5e-3), force_of(0.5, 8), k_of(200, 20000);
  int found = 0, three = 0;
  for (int n = 0; n < 2000; ++n) {
    std::vector<DetentCurve::Knot> knots = {{0, 0}};
    for (int i = 0; i < 4; ++i) knots.push_back({knots.back().travel + travel_of(random), force_of(random)});
    const DetentCurve detent(knots, 8000);
    const double k1 = k_of(random), travel = 6 * travel_of(random);
    const Equilibria all = buttonEquilibria(k1, detent, travel);
    ASSERT_GE(all.count, 1);
    EXPECT_EQ(all.count % 2, 1) << "they come and go in pairs";
    three += all.count >= 3;
    for (int i = 0; i < all.count; ++i, ++found) {
      const Equilibrium& e = all.at[static_cast<size_t>(i)];
      EXPECT_NEAR(e.x1 + e.x2, travel, 1e-15);
      EXPECT_NEAR(e.force, k1 * e.x1, 1e-9);
      EXPECT_NEAR(e.force, detent.force(e.x2), 1e-9);
      EXPECT_EQ(e.stable, i % 2 == 0);
    }
  }
  EXPECT_GT(three, 50) << "the sample must hold snapping buttons";
}

TEST(Button, GivesBackNoMoreThanItTookInAnyClosedPress) {
  const DetentCurve::Knot knots[] = {{0, 0}, {0.003, 6}, {0.004, 2}, {0.006, 4}};
  const DetentCurve detent(knots, 8000);
  for (const double k1 : {500.0, 2000.0, 20000.0}) {
    ButtonState button;
    double work = 0, force = 0, last = 0;
    for (int i = 0; i <= 20000; ++i) {
      const double travel = 4e-3 * (1 - std::cos(2 * M_PI * i / 10000));
      const double next = button.step(k1, detent, travel).at.force;
      work += (force + next) / 2 * (travel - last);
      force = next, last = travel;
    }
    EXPECT_GT(work, -1e-6) << k1;
  }
}

TEST(Button, SaysWhichPointOfTheDetentIsWrong) {
  const auto complaint = [](std::vector<DetentCurve::Knot> knots, double end) -> std::string {
    try {
      DetentCurve curve(knots, end);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(complaint({{0, 0}, {1e-3, 2}}, 100), "");
  EXPECT_NE(complaint({{0, 0}, {1e-3, 2}, {1e-3, 3}}, 100).find("row 3"), std::string::npos);
  EXPECT_NE(complaint({{0, 0}, {1e-3, 2}, {2e-3, 0}}, 100).find("above 0 N"), std::string::npos);
  EXPECT_NE(complaint({{0, 1}}, 100).find("row 1"), std::string::npos);
  EXPECT_NE(complaint({{0, 0}, {1e-3, NAN}}, 100).find("not a finite"), std::string::npos);
  EXPECT_NE(complaint({{0, 0}, {1e-3, 2}}, 0).find("end_stiffness"), std::string::npos);
}

}  // namespace
}  // namespace hapticd::dynamics
