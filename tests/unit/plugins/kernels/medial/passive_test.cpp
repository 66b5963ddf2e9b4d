// SPDX-License-Identifier: MIT
#include "kernels/medial/passive.hpp"

#include <gtest/gtest.h>

#include "felt_bodies.hpp"

namespace hapticd::medial {
namespace {

SurfaceElement elementAt(const Tissue& tissue, double dt) {
  return dampedForTick(elementOf(tissue, test::kRatio), dt);
}

/// Tissues that creep, swing and relax, each with some damping.
std::vector<Tissue> dampedTissues() {
  return {{200, .1, 0, 0, 0},   {200, .6, .01, 0, 0},  {200, .6, .01, .8, .3},
          {961, .5, .01, 0, 0}, {3000, .6, .01, 0, 0}, {3000, 3, .01, 0, 0}};
}

/// What an arm must damp [N s/m] while a hand moves it so often in kTicks ticks: the work of the force that is held
/// from sample to sample, over the least that a damper takes on that way, from the surface that runs.
constexpr int kTicks = 1000;
double measured(const Tissue& tissue, int periods, double dt) {
  test::OnePlace place(tissue, dt);
  const auto depth = [periods](int n) { return 1e-2 + 1e-5 * std::sin(2 * M_PI * periods * n / kTicks); };
  double given = 0, damped = 0;
  for (int n = 0; n < 4 * kTicks; ++n) {
    const double force = place.press(depth(n)), move = depth(n + 1) - depth(n);
    if (n < 3 * kTicks) continue;  // until it has settled
    given -= force * move;
    damped += move * move / dt;
  }
  return given / damped;
}

TEST(PassiveDamping, OfASpringAloneIsHalfItsStiffnessTimesTheTick) {
  for (const double dt : {1e-3, 2.5e-4}) {
    const SurfaceElement creeps = elementAt({200, .5, 0, 0, 0}, dt);
    EXPECT_NEAR(passiveDamping(creeps, dt), 0.5 * dt * creeps.contact, 1e-4 * dt * creeps.contact);
  }
}

/// The force that is held makes as much energy as the damping of the bound takes, at the worst frequency, and at no
/// other more.
TEST(PassiveDamping, IsWhatTheWorstMotionOfAHandNeeds) {
  constexpr double kPassiveTick = 1e-3;
  for (const Tissue& tissue : dampedTissues()) {
    const double bound = passiveDamping(elementAt(tissue, kPassiveTick), kPassiveTick);
    double most = -1;
    for (int periods = 3; periods < kTicks / 2; periods += periods < 200 ? 1 : 13)
      most = std::max(most, measured(tissue, periods, kPassiveTick));
    EXPECT_LT(most, 1.005 * bound) << tissue.stiffness << " " << tissue.damping;
    EXPECT_GT(most, 0.95 * bound) << tissue.stiffness << " " << tissue.damping;
  }
}

TEST(PassiveDamping, AMassThatNothingDampsIsSafeOnNoArm) {
  for (const double stiffness : {200.0, 3000.0})
    EXPECT_EQ(passiveDamping(elementAt({stiffness, 0, .01, 0, 0}, 1e-3), 1e-3), HUGE_VAL) << stiffness;
  EXPECT_EQ(passiveDamping({}, 1e-3), 0);
}

}  // namespace
}  // namespace hapticd::medial
