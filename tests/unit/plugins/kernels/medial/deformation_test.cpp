// SPDX-License-Identifier: MIT
#include "kernels/medial/deformation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "bodies.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kTick = 1e-3;

Press pressAt(double u, double v, double depth, double speed = 0) {
  return {u, v, Vector3d::UnitZ(), depth, speed};
}

double contourShift(const Deformation& body, double u, double v) {
  const Vector4d moved = body.at(u, v);
  return -moved.z() - moved[3];
}

/// The greatest factor by which a step can multiply the energy of a node of this material, whatever its state. The step
/// is linear: in coordinates whose squared length is the energy, it is the square of the norm of its matrix.
long double greatestGain(const Oscillator& o, double dt) {
  const long double place = 1 / std::sqrt(static_cast<long double>(o.stiffness));
  const long double rate = 1 / std::sqrt(static_cast<long double>(o.mass));
  Nodes node(1, {o}, {});
  std::array<long double, 4> matrix{};  // by columns: a place, a rate of energy 1/2
  const double scale = 1 / std::max(static_cast<double>(place), static_cast<double>(rate));
  for (std::size_t column = 0; column < 2; ++column) {
    Eigen::Vector4d x = Eigen::Vector4d::Zero(), v = Eigen::Vector4d::Zero();
    (column == 0 ? x : v)[0] = scale * static_cast<double>(column == 0 ? place : rate);
    node.place(0, x, v);
    const long double start = scale * (column == 0 ? place : rate) / (column == 0 ? x : v)[0] / scale;
    node.advance(dt);
    matrix[2 * column] = start * node.displacement(0)[0] / place;
    matrix[2 * column + 1] = start * node.rate(0)[0] / rate;
    node.reset();
  }
  const auto& [a, c, b, d] = matrix;
  const long double norm = (std::hypot(a + d, b - c) + std::hypot(a - d, b + c)) / 2;  // its greatest singular value
  return norm * norm;
}

TEST(Deformation, NoStepMakesEnergyWhateverTheMaterialTheStateAndTheTick) {
  std::vector<std::array<double, 4>> all;  // k, m, zeta, dt
  for (const double k : {1.0, 1e3, 1e6})
    for (const double m : {1e-6, 1.0, 1e6})
      for (const double zeta : {0.0, 1e-12, 1 - 1e-9, 1.0, 1 + 1e-9, 10.0})
        for (const double dt : {1e-4, 1e-3, 1e-2}) all.push_back({k, m, zeta, dt});
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20'000; ++i) {
    const double k = std::pow(10, 6 * unit(engine)), m = std::pow(10, 12 * unit(engine) - 6);
    const double zeta = i % 4 == 0 ? std::pow(10, -8 * unit(engine)) : 10 * unit(engine);
    all.push_back({k, m, zeta, std::pow(10, -4 + 2 * unit(engine))});
  }
  for (const auto& [k, m, zeta, dt] : all) {
    const Oscillator o{m, 2 * zeta * std::sqrt(k * m), k};
    ASSERT_LE(greatestGain(o, dt), 1) << "k " << k << ", m " << m << ", zeta " << zeta << ", dt " << dt;
  }
}

TEST(Deformation, EnergyOfAStruckBodyLeftAloneNeverGrows) {
  const Skeleton skeleton = test::build(test::sheets()[0], true);
  for (double k = 1; k <= 1e6; k *= 10) {
    for (double m = 1e-6; m <= 1e6; m *= 10) {
      for (const double zeta : {0.0, 1e-6, 0.01, 0.3, 1.0, 3.0, 10.0}) {
        const double b = 2 * zeta * std::sqrt(k * m);
        Deformation body(skeleton, {Oscillator{m, b, k}}, {});
        const Press strike = pressAt(.31, .77, .004, 1.5);
        body.press({&strike, 1});
        double before = body.energy();
        ASSERT_GT(before, 0);
        for (int tick = 0; tick < 1000; ++tick) {
          body.advance(kTick);
          const double now = body.energy();
          ASSERT_LE(now, before) << "k " << k << ", m " << m << ", zeta " << zeta << ", tick " << tick;
          before = now;
        }
      }
    }
  }
}

TEST(Deformation, AStaticPressHoldsStill) {
  const Skeleton skeleton = test::build(test::sheets()[4], true);
  Deformation body(skeleton, {Oscillator{.01, .5, 200}}, {});
  const Press hold = pressAt(.4, .6, .005);
  body.press({&hold, 1});
  const Vector4d first = body.at(.4, .6);
  for (int tick = 0; tick < 5000; ++tick) {
    body.advance(kTick);
    body.press({&hold, 1});
    ASSERT_LT((body.at(.4, .6) - first).norm(), 1e-14);
  }
}

TEST(Deformation, SplitSharesTheDepthBetweenSkeletonAndRadius) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  for (const double split : {0.0, 0.3, 0.5, 1.0}) {
    DeformationOptions options;
    options.split = split;
    Deformation body(skeleton, {Oscillator{.01, .5, 200}}, options);
    const Press hold = pressAt(.4, .6, .005);
    body.press({&hold, 1});
    const Vector4d moved = body.at(.4, .6);
    EXPECT_NEAR(-moved.z() - moved[3], .005, 1e-15);
    EXPECT_NEAR(moved.z() - moved[3], .005 * (1 - 2 * split), 1e-15);  // the opposite side, inward
  }
}

/// How far any control point jumps when a press slides over the whole body in small steps, over the depth.
double greatestJump(const Skeleton& skeleton, std::array<int, 2> influence) {
  DeformationOptions options;
  options.dynamics = false;
  options.influence = influence;
  Deformation body(skeleton, {Oscillator{.01, .5, 200}}, options);
  std::vector<Vector4d> before;
  double jump = 0;
  for (int i = 0; i <= 20000; ++i) {
    const Press slide = pressAt(i / 20000.0, .37, .01);
    body.press({&slide, 1});
    std::vector<Vector4d> now;
    for (std::size_t c = 0; c < body.count(); ++c) now.push_back(body.displacement(c));
    for (std::size_t c = 0; c < before.size(); ++c) jump = std::max(jump, (now[c] - before[c]).norm());
    before = std::move(now);
  }
  return jump / .01;
}

TEST(Deformation, WithAllInfluencedPointsNothingJumps) {
  const Skeleton skeleton = test::build(test::sheets()[4], false);
  EXPECT_LT(greatestJump(skeleton, {4, 4}), 2e-3);  // what a step of 1/20000 moves
  EXPECT_GT(greatestJump(skeleton, {2, 2}), 2e-2);
}

TEST(Deformation, NoInfluenceMovesAControlPointFarBeyondThePress) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  for (int p = 1; p <= 4; ++p) {
    DeformationOptions options;
    options.dynamics = false;
    options.influence = {p, p};
    Deformation body(skeleton, {Oscillator{.01, .5, 200}}, options);
    for (const double u : {0.0, 1e-6, 1e-3, .01, .2, .5, .97, 1.0}) {
      const Press press = pressAt(u, .5, .01);
      body.press({&press, 1});
      EXPECT_NEAR(contourShift(body, u, .5), .01, 1e-15);
      for (std::size_t c = 0; c < body.count(); ++c)
        EXPECT_LT(body.displacement(c).norm(), (p == 4 ? 1.8 : 3.5) * .01) << p << " " << u;
    }
  }
}

TEST(Deformation, SeveralContactsEachHoldTheContourAtTheProbe) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  Deformation body(skeleton, {Oscillator{.01, .5, 200}}, {});
  const std::array<Press, 3> presses{pressAt(.3, .3, .004), pressAt(.5, .35, .006), pressAt(.8, .7, .002)};
  for (int tick = 0; tick < 20; ++tick) {
    body.advance(kTick);
    body.press(presses);
  }
  for (const Press& press : presses) EXPECT_GE(contourShift(body, press.u, press.v), press.depth - 1e-6);
  EXPECT_NEAR(contourShift(body, .5, .35), .006, 1e-5);
}

TEST(Deformation, SleepsAgainWhenItHasSettled) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  Deformation body(skeleton, {Oscillator{.01, 1, 200}}, {});
  EXPECT_EQ(body.awake(), 0u);
  const Press press = pressAt(.5, .5, .005);
  body.press({&press, 1});
  EXPECT_EQ(body.awake(), 16u);
  for (int tick = 0; tick < 5000 && body.awake() > 0; ++tick) body.advance(kTick);
  EXPECT_EQ(body.awake(), 0u);
  EXPECT_EQ(body.energy(), 0);
}

TEST(Deformation, OneLongStepIsManyShortOnes) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  Deformation once(skeleton, {Oscillator{.01, .1, 200}}, {}), often(skeleton, {Oscillator{.01, .1, 200}}, {});
  const Press press = pressAt(.5, .5, .005);
  once.press({&press, 1});
  often.press({&press, 1});
  once.advance(.25);
  for (int tick = 0; tick < 250; ++tick) often.advance(kTick);
  EXPECT_LT((once.at(.5, .5) - often.at(.5, .5)).norm(), 1e-13);
}

TEST(Deformation, BodiesWithoutMassCreepAndWithoutSpringReturnAtOnce) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  const Press press = pressAt(.5, .5, .005);
  Deformation creeps(skeleton, {Oscillator{0, 10, 200}}, {}), limp(skeleton, {Oscillator{1, 10, 0}}, {});
  creeps.press({&press, 1});
  limp.press({&press, 1});
  creeps.advance(.01);
  limp.advance(.01);
  EXPECT_NEAR(contourShift(creeps, .5, .5), .005 * std::exp(-.2), 1e-12);
  EXPECT_EQ(limp.awake(), 0u);
}

TEST(Deformation, ForgetsWhatIsNoNumber) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  Deformation body(skeleton, {Oscillator{.01, .1, 200}}, {});
  const Press bad = pressAt(.5, .5, NAN), mad = pressAt(.5, .5, .001, INFINITY);
  body.press({&bad, 1});
  body.press({&mad, 1});
  body.advance(kTick);
  EXPECT_TRUE(std::isfinite(body.energy()));
  EXPECT_THROW(Deformation(skeleton, {Oscillator{-1, 0, 1}}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace hapticd::medial
