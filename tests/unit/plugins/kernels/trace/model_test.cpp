// SPDX-License-Identifier: MIT
#include "kernels/trace/model.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "hand.hpp"
#include "kernels/trace/box_tree.hpp"
#include "kernels/trace/newton.hpp"
#include "shapes.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

/// Nearest distance by Newton from every node of a dense grid.
double bruteForce(const Patch& patch, const Vector3d& p, int cells) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) {
      Iterate at;
      at.uv = patch.lo + (patch.hi - patch.lo) * Array2d(i, j) / cells;
      best = std::min(best, newtonFoot(patch, p, at, 1e-13, 60).distance);
    }
  return best;
}

TEST(Model, GlobalSearchIsExactAgainstBruteForce) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.03, 0.13), height(-0.06, 0.06);
  for (int surface = 0; surface < 6; ++surface) {
    const Model model({randomPatch(random, 8, surface % 2 == 1)});
    for (int probe = 0; probe < 20; ++probe) {
      const Vector3d p(place(random), place(random), height(random));
      Near near;
      ASSERT_EQ(model.nearby(p, 1, &near, 1), 1);
      EXPECT_NEAR(near.distance, bruteForce(model.patch(0), p, 40), 1e-9);
      spline::SurfacePoint E;
      model.patch(0).surface.evaluate1(near.u, near.v, E);
      EXPECT_NEAR((E.S - p).norm(), near.distance, 1e-12);  // (u, v) belong to the distance
    }
  }
}

TEST(Model, NearbyListsEverySurfaceWithinTheRadiusNearestFirst) {
  const Model model = solid("teapot");
  std::vector<Near> near(32), all(32);
  const Vector3d p(0.05, 0.01, 0.01);
  ASSERT_EQ(model.nearby(p, 10, all.data(), all.size()), 32);
  const std::int64_t count = model.nearby(p, 0.03, near.data(), near.size());
  ASSERT_GT(count, 1);
  for (std::int64_t i = 0; i < 32; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(i < count, all[at].distance <= 0.03);
    if (i < count) {
      EXPECT_EQ(near[at].surface, all[at].surface);
    }
    if (i > 0) {
      EXPECT_GE(all[at].distance, all[at - 1].distance);
    }
  }
  EXPECT_EQ(model.nearby(p, 0.03, near.data(), 1), count);
}

TEST(Model, SolidsAreSewnIntoOneClosedShell) {
  for (const char* name : {"box", "cylinder", "torus", "sphere", "goblet"}) {
    const Model model = solid(name);
    EXPECT_EQ(model.shellCount(), 1) << name;
    EXPECT_TRUE(model.closed(0)) << name;
    EXPECT_TRUE(model.warnings().empty()) << name;
  }
}

TEST(Model, ReportsATJunction) {
  const auto square = [](double x0, double x1, double y0, double y1) {
    spline::SurfaceData data;
    data.knots = {{{0, 0, 1, 1}, {0, 0, 1, 1}}};
    data.points = {{x0, y0, 0}, {x0, y1, 0}, {x1, y0, 0}, {x1, y1, 0}};
    return data;
  };
  const Model model({square(0, 1, 0, 1), square(1, 2, 0, 0.5), square(1, 2, 0.5, 1)});
  EXPECT_EQ(model.shellCount(), 2);
  ASSERT_FALSE(model.warnings().empty());
  EXPECT_NE(model.warnings().front().find("T-junction"), std::string::npos);
}

TEST(Model, WarnsOfNeighboursWithOppositeOutsides) {
  // The right square's parameters in all eight ways: swapped, and each of them running back.
  for (int way = 0; way < 8; ++way) {
    const auto corner = [way](int i, int j) {
      if (way & 1) i = 1 - i;
      if (way & 2) j = 1 - j;
      if (way & 4) std::swap(i, j);
      return Eigen::Vector3d(1 + i, j, 0);
    };
    spline::SurfaceData left, right;
    left.knots = right.knots = {{{0, 0, 1, 1}, {0, 0, 1, 1}}};
    left.points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}};
    right.points = {corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)};
    const Eigen::Vector3d du = corner(1, 0) - corner(0, 0), dv = corner(0, 1) - corner(0, 0);
    const bool up = du.cross(dv).z() > 0;  // as the left one
    for (const bool reversed : {false, true}) {
      right.reversed = reversed;
      const Model model({left, right});
      EXPECT_EQ(model.shellCount(), 1);
      ASSERT_EQ(model.warnings().size(), up == reversed ? 1u : 0u) << "way " << way << ", reversed " << reversed;
      if (up == reversed) {
        EXPECT_NE(model.warnings().front().find("opposite sides"), std::string::npos);
      }
    }
  }
}

TEST(Model, AnEmptyModelIsRefused) {
  EXPECT_THROW(Model({}), std::invalid_argument);
}

/// A surface whose points lie in one place or on one line has no normal: a hand was pulled to it from anywhere.
TEST(Model, ASurfaceWithoutAreaIsNotFelt) {
  for (const Vector3d& end : {Vector3d(0, 0, 0.1), Vector3d(0.02, 0.03, 0.15)}) {
    const spline::SurfaceData line = flat({0, 0, 0.1}, {0, 0, 0.1}, end);
    const spline::SurfaceData floor = flat({-0.1, -0.1, 0}, {0.1, -0.1, 0}, {-0.1, 0.1, 0});
    const Model model({line, floor}), alone({floor});
    EXPECT_EQ(model.surfaceCount(), 2);
    Hand hand{model}, truth{alone};
    for (int i = 0; i < 1000; ++i) {  // round the line, and into the floor
      const Vector3d p = end + Vector3d(0.02 * std::cos(0.05 * i), 0.02 * std::sin(0.05 * i), -1.7e-4 * i);
      const Foot foot = hand.at(p), expected = truth.at(p);
      ASSERT_EQ(foot.surface, contact::found(expected) ? 1 : -1);
      ASSERT_EQ(foot.depth, expected.depth) << i;
    }
  }
}

TEST(Model, WithoutAnyAreaIsTracedAndNeverTouched) {
  EXPECT_FALSE(Model({flat({0, 0, 0}, {1e-320, 0, 0}, {0, 1e-320, 0})}).hasArea()) << "it is a point";
  const spline::SurfaceData dot = flat({0, 0, 0.1}, {0, 0, 0.1}, {0, 0, 0.1});
  const spline::SurfaceData line = flat({0, 0, 0.1}, {0, 0, 0.1}, {0.02, 0.03, 0.15});
  const spline::SurfaceData strip = flat({0, 0, 0.1}, {5e-11, 0, 0.1}, {0, 0.1, 0.1});  // it has a normal
  for (const spline::SurfaceData& thin : {dot, line, strip})
    for (const auto sides : {contact::Sides::kFront, contact::Sides::kBack, contact::Sides::kBoth})
      for (const double hysteresis : {0.0, 1.0}) {
        const Model model({thin});
        Hand hand{model};
        hand.options = holding(sides, hysteresis);
        const Vector3d a = thin.points[0], way = thin.points[1] - a, middle = (a + thin.points[3]) / 2;
        for (const double side : {-0.03, 0.03}) EXPECT_LE(hand.at(middle + Vector3d(0, 0, side)).depth, 0) << side;
        for (int i = 0; i < 1000; ++i) {  // round it, past it and through it
          const Vector3d p = a + 1e-4 * (i - 500) * Vector3d(std::cos(0.05 * i), std::sin(0.05 * i), 0.3);
          const double along = way.squaredNorm() > 0 ? (p - a).dot(way) / way.squaredNorm() : 0;
          const Foot foot = hand.at(p);
          ASSERT_TRUE(contact::found(foot));
          ASSERT_LE(foot.depth, 0) << i;
          ASSERT_NEAR(foot.distance, (p - a - std::clamp(along, 0.0, 1.0) * way).norm(), 1e-8) << i;
          ASSERT_TRUE(foot.normal.allFinite());
        }
      }
}

TEST(Model, NotANumberIsNearNothing) {
  Near near;
  EXPECT_EQ(solid("sphere").nearby(Vector3d::Constant(NAN), 1, &near, 1), 0);
}

/// A flat strip of 0.1 mm along a quarter of a circle: its short tangents turn from one side of the strip to the other,
/// but not along themselves, so to halve it along them leads nowhere.
TEST(BoxTree, HalvesAStripAcrossItsLength) {
  constexpr double kArm = 0.5522847498;  // of a cubic arc over a right angle, relative to its radius
  spline::SurfaceData strip;
  strip.degree = {1, 3};
  strip.knots = {std::vector<double>{0, 0, 1, 1}, std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1}};
  for (const double r : {0.02, 0.0201})
    for (const auto& [x, y] : {std::pair(1.0, 0.0), std::pair(1.0, kArm), std::pair(kArm, 1.0), std::pair(0.0, 1.0)})
      strip.points.emplace_back(r * x, r * y, 0);
  BoxTree tree;
  tree.add(strip, 0);
  EXPECT_LE(tree.leafCount(), 16);
}

}  // namespace
}  // namespace hapticd::trace
