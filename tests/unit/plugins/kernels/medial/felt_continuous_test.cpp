// SPDX-License-Identifier: MIT
/// The sampled surface beside the continuous one that it stands for: what the tick costs in accuracy.
#include <gtest/gtest.h>

#include "felt_bodies.hpp"

namespace hapticd::medial {
namespace {

using test::Continuous;
using test::OnePlace;

const std::vector<Tissue>& tissues() {
  static const std::vector<Tissue> all{
      {200, .8, 0, 0, 0}, {200, .6, .01, 0, 0}, {150, .5, .01, .8, .25}, {800, 4, .01, 0, 0}};
  return all;
}

/// Greatest force error of a press at 0.1 m/s to 4 mm that is then held, over the greatest force.
double pressError(const Tissue& tissue, double dt) {
  OnePlace place(tissue, dt);
  const SurfaceElement e = elementOf(tissue, test::kRatio);
  const Continuous truth(e);
  place.press(0);
  std::array<double, 3> z{};
  double worst = 0, greatest = 0, depth = 0;
  const auto steps = static_cast<int>(std::lround(.2 / dt)), inward = static_cast<int>(std::lround(.04 / dt));
  for (int n = 1; n <= steps; ++n) {
    const double rate = n <= inward ? .1 : 0;
    z = truth.contact(z, depth, rate, dt);
    depth += rate * dt;
    const double force = place.press(depth), wanted = e.contact * (depth - z[0]);
    worst = std::max(worst, std::fabs(force - wanted));
    greatest = std::max(greatest, wanted);
  }
  return worst / greatest;
}

TEST(FeltContinuous, APressErrsByTheSquareOfTheTick) {
  for (const Tissue& tissue : tissues()) {
    const double slow = pressError(tissue, 1e-3), middle = pressError(tissue, 5e-4), fast = pressError(tissue, 2.5e-4);
    EXPECT_LT(slow, 2e-2) << tissue.mass;
    EXPECT_LT(middle, slow / 3.5);
    EXPECT_LT(fast, middle / 3.5);
  }
}

TEST(FeltContinuous, AStepIsRightFromTheThirdTickOn) {
  for (const Tissue& tissue : tissues()) {
    for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
      OnePlace place(tissue, dt);
      const SurfaceElement e = elementOf(tissue, test::kRatio);
      place.press(0);
      std::array<double, 3> z = Continuous(e).contact({}, 0, 1e-3 / dt, dt);  // what is between two samples is a ramp
      place.press(1e-3);
      for (int n = 1; n < 50; ++n) {
        z = Continuous(e).contact(z, 1e-3, 0, dt);
        const double force = place.press(1e-3), wanted = e.contact * (1e-3 - z[0]);
        if (wanted < 0) break;  // a light surface jumps away
        if (n <= 2) continue;
        ASSERT_NEAR(force, wanted, .12 * e.contact * 1e-3 * (dt / 1e-3)) << n;
      }
    }
  }
}

/// Pressed, let go, and pressed again while the dent is there: free, the surface is exact, and the second contact
/// begins where it is.
TEST(FeltContinuous, TheDentOfAReleasedPressIsExactAndIsMetAgain) {
  for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
    const Tissue tissue{200, 10, 0, 0, 0};
    const SurfaceElement e = elementOf(tissue, test::kRatio);
    OnePlace place(tissue, dt);
    const auto ticks = [dt](double t) { return static_cast<int>(std::lround(t / dt)); };
    for (int n = 0; n <= ticks(1); ++n) place.press(4e-3 * std::min(1.0, n * dt / .1));
    for (int n = 0; n < ticks(.01); ++n) ASSERT_EQ(place.press(-1e-3), 0);
    const double dent = place.shift();
    for (int n = 1; n <= ticks(.02); ++n) {
      place.press(-1e-3);
      ASSERT_NEAR(place.shift(), dent * std::exp(-e.stiffness / e.damping * n * dt), 1e-12);
    }
    // Down again at 0.2 m/s: the force begins within a tick of when the probe is at the dent.
    double depth = -1e-3, force = 0, met = 0;
    while (force == 0 && depth < 4e-3) {
      met = place.shift();
      depth += .2 * dt;
      force = place.press(depth);
    }
    EXPECT_GT(met, 1e-3);
    EXPECT_LE(std::fabs(depth - met), .2 * dt + 1e-9);
  }
}

TEST(FeltContinuous, StorageAndLossModulusErrByTheSquareOfTheTick) {
  for (const Tissue& tissue : tissues()) {
    const SurfaceElement e = elementOf(tissue, test::kRatio);
    for (const double hertz : {.1, 1.0, 10.0, 50.0, 100.0}) {
      const std::complex<double> truth = test::impedance(e, 2 * M_PI * hertz);
      double before = 0;
      for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
        const double error = std::abs(test::measuredImpedance(tissue, hertz, dt) - truth) / std::abs(truth);
        const double w = 2 * M_PI * hertz, fastest = (e.contact + e.stiffness + e.branch) / e.damping;
        EXPECT_LT(error, .25 * w * dt * (w + fastest) * dt + 1e-6) << hertz << " Hz, " << dt;
        if (before > 1e-4) {
          EXPECT_LT(error, before / 3.5) << hertz << " Hz, " << dt;
        }
        before = error;
      }
    }
  }
}

}  // namespace
}  // namespace hapticd::medial
