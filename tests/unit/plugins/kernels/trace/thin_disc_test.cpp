// SPDX-License-Identifier: MIT
/// A thin disc of several surfaces, whose front is felt: rivals come and go, and the far face is never far.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "hand.hpp"
#include "shapes.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.05;

/// The strips of a disc between y = 0 and y = thickness, from the middle of its bottom to that of its top.
std::vector<spline::SurfaceData> strips(double thickness) {
  const double t = thickness;
  const std::vector<std::array<double, 2>> corners{
      {0, 0}, {0.02, 0}, {kRadius, 0}, {kRadius, t / 3}, {kRadius, 2 * t / 3}, {kRadius, t}, {0.02, t}, {0, t}};
  std::vector<spline::SurfaceData> all;
  for (std::size_t i = 1; i < corners.size(); ++i)
    all.push_back(turned({{corners[i - 1][0], corners[i - 1][1], 1}, {corners[i][0], corners[i][1], 1}}));
  return all;
}

/// Ticks of a walk about the rim whose foot does not belong to the probe.
int oldFeet(const Model& model, double thickness, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0.1, 1);
  const Vector3d home(kRadius, 0.5 * thickness, 0), out(1, 0, 0);
  Hand hand{model};
  int old = 0;
  for (int part = 0; part < 8; ++part) {
    const double reach = std::pow(10, -4.5 + 1.8 * (part + 0.5) / 8);
    Vector3d p = home + 1.5 * reach * out;
    hand.tracer.step(Vector3d::Constant(NAN), hand.options);
    for (int tick = 0; tick < 150; ++tick) {
      const Foot foot = hand.at(p);
      old += std::abs((p - foot.point).norm() - foot.distance) > 1e-9;
      Vector3d step(normal(random), normal(random), normal(random));
      step *= 0.5 * reach * share(random);
      step -= 0.5 * (p - home);
      step -= (out.dot(step) + 0.3 * out.dot(p - home) - 0.1 * reach * normal(random)) * out;
      p += step;
    }
  }
  return old;
}

/// The track of the nearest foot may be dropped in the same tick, and its place used again by another one.
TEST(ThinDisc, IsFeltAtFeetOfThisTick) {
  for (const double thickness : {3e-4, 1e-3}) {
    const Model model(strips(thickness));
    int old = 0;
    for (unsigned seed = 0; seed < 100; ++seed) old += oldFeet(model, thickness, seed);
    EXPECT_EQ(old, 0) << thickness;
  }
}

/// After a lost sample the probe is outside, on the other side of the disc. A foot found while other faces were left
/// unseen is not held: it would pull the probe through.
TEST(ThinDisc, HoldsNoFootThatMayNotBeTheNearest) {
  for (const double thickness : {1e-4, 1e-3}) {
    const Model model(strips(thickness));
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> exponent(-4, -2.3);
    int pushed = 0;
    for (int i = 0; i < 100; ++i) {
      const double x = 0.005 * normal(random), z = 0.005 * normal(random);
      Vector3d above(x, thickness + std::pow(10, exponent(random)), z), below(z, -std::pow(10, exponent(random)), x);
      if (i % 2 == 0) std::swap(above, below);
      Hand hand{model};
      for (int tick = 0; tick < 12; ++tick) hand.at(above);
      hand.tracer.step(Vector3d::Constant(NAN), hand.options);
      double depth = 0;
      for (int tick = 0; tick < 40; ++tick) depth = hand.at(below).depth;
      pushed += depth > 0;
    }
    EXPECT_EQ(pushed, 0) << thickness;
  }
}

}  // namespace
}  // namespace hapticd::trace
