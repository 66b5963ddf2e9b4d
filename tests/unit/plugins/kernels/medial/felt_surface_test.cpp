// SPDX-License-Identifier: MIT
#include "kernels/medial/felt_surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "felt_bodies.hpp"
#include "kernels/medial/unilateral.hpp"

namespace hapticd::medial {
namespace {

using test::OnePlace;

/// Tissues that creep, swing, relax, and do all of it.
std::vector<Tissue> feltTissues() {
  return {{200, .8, 0, 0, 0},     {200, .6, .01, 0, 0},    {200, 0, .01, 0, 0}, {1000, 40, .002, 0, 0},
          {150, .5, 0, .8, .25},  {150, .5, .01, .8, .25}, {400, .05, 0, 0, 0}, {300, 0, 0, 1.5, .02},
          {50, .001, 1e-7, 0, 0}, {900, 2, .03, 2, .004},  {200, 20, 0, 0, 0}};
}

TEST(FeltSurface, AContactForceTakesFromTheSpringWhatItGivesToTheSurface) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 200'000; ++i) {
    const double k = std::pow(10, 3 * unit(engine)), before = 1e-3 * unit(engine), ahead = 1e-3 * unit(engine);
    const double give = i % 10 == 0 ? 0 : std::pow(10, 4 * unit(engine) - 2);
    const double force = meanContactForce(k, before, ahead, give), after = ahead - give * force;
    const auto stored = [k](double d) { return 0.5 * k * std::pow(std::max(0.0, d), 2); };
    ASSERT_GE(force, 0);
    const double difference = force * (after - before) - (stored(after) - stored(before));
    ASSERT_NEAR(difference, 0, 1e-12 * (stored(after) + stored(before)) + 1e-24) << i;
  }
}

/// Matrix of one tick in contact, by the definition of the scheme: the exact solution under the mean of the contact
/// forces at both ends, solved for the state (x, v, y).
struct Scheme {
  Eigen::Matrix3d a;
  Eigen::Vector3d b;  ///< of the mean of the depths at both ends
  Scheme(const SurfaceElement& e, double dt) {
    const ViscoelasticStep s = viscoelasticStep(e, dt);
    Eigen::Matrix3d free;
    free << s.xx, s.xv, s.xy, s.vx, s.vv, s.vy, s.yx, s.yv, s.yy;
    const Eigen::Vector3d force = e.contact * Eigen::Vector3d(s.xf, s.vf, s.yf);
    const Eigen::RowVector3d half(.5, 0, 0);
    const Eigen::Matrix3d implicit = Eigen::Matrix3d::Identity() + force * half;
    a = implicit.partialPivLu().solve(free - force * half);
    b = implicit.partialPivLu().solve(force);
  }
  /// The state after n ticks of a steady ramp, from `start` at rest at the depth `from`: powers of the matrix alone.
  Eigen::Vector3d after(int n, double from, double slope) const {
    Eigen::Matrix<double, 5, 5> whole = Eigen::Matrix<double, 5, 5>::Zero();  // state, depth, 1
    whole.topLeftCorner<3, 3>() = a;
    whole.block<3, 1>(0, 3) = b;
    whole.block<3, 1>(0, 4) = 0.5 * slope * b;
    whole(3, 3) = whole(4, 4) = 1;
    whole(3, 4) = slope;
    Eigen::Matrix<double, 5, 5> power = Eigen::Matrix<double, 5, 5>::Identity();
    for (int left = n; left > 0; left /= 2, whole = whole * whole)
      if (left % 2 == 1) power = power * whole;
    Eigen::Matrix<double, 5, 1> state;
    state << 0, 0, 0, from, 1;
    return (power * state).head<3>();
  }
};

TEST(FeltSurface, FollowsTheClosedFormOfItsScheme) {
  for (const double dt : {1e-3, 5e-4, 2.5e-4}) {
    for (const Tissue& tissue : feltTissues()) {
      OnePlace place(tissue, dt);
      const Scheme scheme(place.element(), dt);
      const double slope = 2e-6;  // ramps inward never lose contact
      place.press(0);
      for (int n = 1; n <= 2000; ++n) {
        const double force = place.press(slope * n);
        if (n % 97 != 0 && n > 5) continue;
        const double shift = scheme.after(n, 0, slope)[0];
        ASSERT_NEAR(force, place.element().contact * (slope * n - shift), 1e-9 * (force + 1e-3))
            << "k " << tissue.stiffness << " b " << tissue.damping << " m " << tissue.mass << " dt " << dt << " n "
            << n;
      }
    }
  }
}

TEST(FeltSurface, AHeldPressFeelsTheStiffnessOfTheTissueAndStandsStill) {
  for (const Tissue& tissue : feltTissues()) {
    if (tissue.damping == 0 && tissue.mass > 0) continue;  // swings for ever
    OnePlace place(tissue, 1e-3);
    for (int i = 0; i <= 100; ++i) place.press(4e-5 * i);
    for (int i = 0; i < 40'000; ++i) place.press(4e-3);
    const double held = place.press(4e-3);
    EXPECT_NEAR(held, 4e-3 * tissue.stiffness, 1e-12) << tissue.stiffness << " " << tissue.damping;
    for (int i = 0; i < 3000; ++i) ASSERT_NEAR(place.press(4e-3), held, 1e-13);
  }
}

TEST(FeltSurface, FeelsStiffnessDampingAndMassAtLowFrequencies) {
  for (const Tissue& tissue : feltTissues()) {
    if (tissue.relaxation_share > 0) continue;
    const SurfaceElement e = elementOf(tissue, test::kRatio);
    const double w = 1e-3;
    const std::complex<double> felt = test::impedance(e, w);
    EXPECT_NEAR(felt.real(), tissue.stiffness - w * w * tissue.mass, 1e-5 * tissue.stiffness);
    EXPECT_NEAR(felt.imag(), w * tissue.damping, 1e-4 * w * tissue.damping + 1e-15);
  }
}

/// A press that is 1 mm deep at once relaxes as the file says.
TEST(FeltSurface, RelaxesByItsShareInItsTime) {
  const Tissue tissue{150, 0, 0, .8, .25};
  OnePlace place(tissue, 1e-3);
  place.press(0);
  place.press(1e-3);
  double worst = 0;
  for (int n = 1; n < 2000; ++n) {
    const double force = place.press(1e-3);
    if (n > 20) worst = std::max(worst, std::fabs(force / (1e-3 * 150 * (1 + .8 * std::exp(-1e-3 * n / .25))) - 1));
  }
  EXPECT_LT(worst, 4e-3);
}

TEST(FeltSurface, AProbeThatIsFasterThanTheSurfaceLosesItAndMeetsTheDent) {
  OnePlace place({200, 20, 0, 0, 0}, 1e-3);  // forgets in some 0.15 s
  for (int i = 0; i <= 2000; ++i) place.press(4e-3 * std::min(1.0, i / 200.0));
  const double dent = place.shift();
  EXPECT_NEAR(dent, 4e-3 * (1 - 1 / test::kRatio), 1e-5);
  EXPECT_EQ(place.press(2e-3), 0);  // 2 mm out in a tick
  EXPECT_EQ(place.press(2e-3), 0);
  EXPECT_GT(place.shift(), 2.5e-3);
  EXPECT_EQ(place.press(2.4e-3), 0);      // the dent is still there
  EXPECT_GT(place.press(3e-3), 0);        // and is met at its bottom
  EXPECT_LT(place.press(3e-3), .5 * .6);  // not as if it were not there: that would be more than 0.6 N
  for (int i = 0; i < 2000; ++i) place.press(-1e-3);
  EXPECT_LT(place.shift(), 1e-6);
}

TEST(FeltSurface, NoImpactKicks) {
  for (const double mass : {1e-3, .01, .1, 1.0}) {
    OnePlace place({200, .6, mass, 0, 0}, 1e-3);
    double before = place.press(0), most = 0;
    for (int i = 1; i < 40; ++i) {  // 0.5 m/s: m v / T would be 5 N for 10 g
      const double force = place.press(5e-4 * i);
      most = std::max(most, std::fabs(force - before));
      before = force;
    }
    EXPECT_LE(most, 200 * test::kRatio * 5e-4 * (1 + 1e-9)) << mass;
  }
}

/// Random motions of the probe: what it has put in is never less than what is stored, tick by tick, and no part of a
/// run gives back more than it found.
TEST(FeltSurface, AMillionRandomMotionsMakeNoEnergy) {
  std::mt19937 engine(17);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  int ticks = 0;
  for (int run = 0; ticks < 1'000'000; ++run) {
    const Tissue tissue = feltTissues()[static_cast<std::size_t>(run) % feltTissues().size()];
    const double dt = std::pow(10, -4 + 2 * unit(engine)), jump = std::pow(10, -6 + 3.5 * unit(engine));
    OnePlace place(tissue, dt);
    double depth = -1e-4;
    place.press(depth);
    double before = place.energy, worked = 0, greatest = 0;
    for (int i = 0; i < 2000; ++i, ++ticks) {
      const double next = std::clamp(depth + jump * normal(engine), -2e-3, 8e-3);
      place.press(next);
      const double work = place.mean * (next - depth);
      greatest = std::max(greatest, place.energy);
      ASSERT_LE(place.energy - before, work + 1e-13 * (greatest + std::fabs(work)) + 1e-22)
          << "run " << run << " tick " << i << " b " << tissue.damping << " m " << tissue.mass << " dt " << dt;
      worked += work;
      ASSERT_GE(worked, -1e-12 * greatest) << run;
      before = place.energy;
      depth = next;
    }
  }
}

}  // namespace
}  // namespace hapticd::medial
