// SPDX-License-Identifier: MIT
#include "kernels/medial/skeleton.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bodies.hpp"
#include "support/sweep.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;
using test::Sheet;

const int kQueries = support::kLong ? 3000 : 1000;
constexpr double kRadius = .01;

/// Points within 12 mm of the skeleton.
class Random {
 public:
  Vector3d near(const Sheet& sheet) {
    const double s = unit_(engine_), t = unit_(engine_);
    const double x = sign_(engine_), y = sign_(engine_), z = sign_(engine_);
    return sheet.at(s, t) + .012 * Vector3d(x, y, z);
  }

 private:
  std::mt19937 engine_{1};
  std::uniform_real_distribution<double> unit_{0, 1}, sign_{-1, 1};
};

TEST(Skeleton, ColdSearchFindsTheNearestSphereOfTheExactEnvelope) {
  Random random;
  for (const bool varying : {false, true}) {
    for (const Sheet& sheet : test::sheets()) {
      const Skeleton skeleton = test::build(sheet, varying);
      const test::BruteForce brute(skeleton);
      double worst = 0;
      int failures = 0;
      for (int k = 0; k < kQueries; ++k) {
        const Vector3d p = random.near(sheet);
        const double error = brute.depth(p) - skeleton.search(p, {}).depth;
        worst = std::max(worst, error);
        failures += error > .01 * kRadius ? 1 : 0;
      }
      EXPECT_EQ(failures, 0) << sheet.name << (varying ? ", radii vary" : "") << ", worst " << worst;
      EXPECT_LT(worst, 2e-7) << sheet.name << (varying ? ", radii vary" : "");
    }
  }
}

TEST(Skeleton, WarmSearchFollowsAMovingProbeInFiveEvaluations) {
  for (const bool varying : {false, true}) {
    for (const Sheet& sheet : test::sheets()) {
      const Skeleton skeleton = test::build(sheet, varying);
      SkeletonFoot foot;
      int most = 0, slow = 0;
      for (int k = 0; k < 2000; ++k) {  // 1 kHz, about 0.2 m/s, 6 mm from the skeleton
        const double s = .3 + .4 * k / 2000, t = .4 + .2 * std::sin(20 * s);
        spline::SurfacePoint at;
        skeleton.surface().evaluate1(s, t, at);
        const Vector3d normal = sheet.curve ? at.Sv.unitOrthogonal() : at.Su.cross(at.Sv).normalized();
        const Vector3d p = at.S + .006 * normal;
        foot = k == 0 ? skeleton.search(p, {}) : skeleton.nearest(p, foot.u, foot.v, {});
        if (k == 0) continue;
        most = std::max(most, foot.evaluations);
        slow += foot.evaluations > 5 ? 1 : 0;
        EXPECT_TRUE(foot.converged) << sheet.name;
      }
      EXPECT_LE(most, 5) << sheet.name << (varying ? ", radii vary, slow " : ", slow ") << slow;
    }
  }
}

TEST(Skeleton, WarmSearchConvergesQuicklyOnARimWhereTheRadiusRisesInward) {
  SkeletonGrid grid;
  grid.count = {5, 5};
  for (int i = 0; i < 25; ++i) {
    const double s = (i / 5) / 4.0, t = (i % 5) / 4.0;
    grid.points.emplace_back(.02 * s, .02 * t, .003 * (1 - std::pow(2 * s - 1, 2)) * (1 - std::pow(2 * t - 1, 2)));
    grid.radius.push_back(.01 + .004 * std::sin(M_PI * s) * std::sin(M_PI * t));
  }
  const Skeleton skeleton(grid);
  SkeletonFoot foot = skeleton.search({.005, .05, .01}, {});
  for (int k = 1; k < 100; ++k) {
    foot = skeleton.nearest({.005 + 1e-4 * k, .05, .01}, foot.u, foot.v, {});
    EXPECT_TRUE(foot.converged && foot.rim);
    EXPECT_LE(foot.evaluations, 5);
  }
}

TEST(Skeleton, WarmSearchRefusesWhatIsNoNumber) {
  const Skeleton skeleton = test::build(test::sheets()[0], true);
  EXPECT_FALSE(skeleton.nearest({NAN, 0, 0}, .5, .5, {}).converged);
  EXPECT_FALSE(skeleton.nearest({0, 0, 0}, NAN, .5, {}).converged);
}

TEST(Skeleton, NearTheSkeletonTheNormalIsTheOneThatTheConditionOfTheFootGives) {
  for (const bool varying : {false, true}) {
    for (const Sheet& sheet : test::sheets()) {
      const Skeleton skeleton = test::build(sheet, varying);
      if (sheet.curve || skeleton.nested()) continue;
      for (const double height : {0., 1e-12, 1e-10, -1e-9, 3e-9, -1e-8, 1e-7, -9e-7}) {
        spline::SurfacePoint s;
        skeleton.surface().evaluate1(.62, .41, s);
        const Vector3d across = s.Su.cross(s.Sv).normalized();
        SkeletonFoot foot;
        foot.u = .621, foot.v = .4;
        for (int tick = 0; tick < 6; ++tick) {
          foot = skeleton.nearest(s.S + height * across, foot.u, foot.v, {});
          skeleton.surface().evaluate1(foot.u, foot.v, s);
          const auto radius = skeleton.radius().evaluate2(foot.u, foot.v);
          EXPECT_NEAR(foot.normal.norm(), 1, 1e-12);
          EXPECT_LT(std::fabs(foot.normal.dot(s.Su) + radius.fu), 1e-5 * s.Su.norm()) << sheet.name << " " << height;
          EXPECT_LT(std::fabs(foot.normal.dot(s.Sv) + radius.fv), 1e-5 * s.Sv.norm()) << sheet.name << " " << height;
          skeleton.surface().evaluate1(.62, .41, s);
        }
        if (std::fabs(height) > 1e-10) {
          EXPECT_EQ(foot.normal.dot(across) > 0, height > 0) << sheet.name << " " << height;
        }
      }
    }
  }
}

TEST(Skeleton, BothFormsOfTheSplineGiveTheSameFoot) {
  Random random;
  for (const Sheet& sheet : test::sheets()) {
    const Skeleton fast = test::build(sheet, true), small = test::build(sheet, true, spline::Form::kNet);
    for (int k = 0; k < 100; ++k) {
      const Vector3d p = random.near(sheet);
      EXPECT_NEAR(fast.search(p, {}).depth, small.search(p, {}).depth, 1e-11) << sheet.name;
    }
  }
}

TEST(Skeleton, NestedBisectionHalvesItsErrorWithEachHalving) {
  Random random;
  const std::vector<Sheet> sheets = test::sheets();
  for (std::size_t i : {0u, 2u, 4u}) {  // flat, skew 45, dome: one minimum along each line
    const Skeleton skeleton = test::build(sheets[i], false);
    for (const int halvings : {6, 10, 16}) {
      double worst = 0;
      for (int k = 0; k < 300; ++k) {
        const Vector3d p = random.near(sheets[i]);
        const SkeletonFoot truth = skeleton.search(p, {}), found = skeleton.bisect(p, Envelope::kExact, halvings);
        worst = std::max(worst, (found.center - truth.center).norm());
        EXPECT_LE(found.evaluations, halvings * halvings + 1);
      }
      EXPECT_LT(worst, .4 * std::ldexp(1, -halvings)) << sheets[i].name << ", " << halvings;
    }
  }
}

TEST(Skeleton, TheBoxHoldsEverySphereAndBoundsTheDistance) {
  Random random;
  for (const Sheet& sheet : test::sheets()) {
    const Skeleton skeleton = test::build(sheet, true);
    for (int k = 0; k < 300; ++k) {
      const Vector3d p = 5 * random.near(sheet);
      EXPECT_LE(skeleton.leastDistance(p), std::max(0.0, -skeleton.search(p, {}).depth) + 1e-12) << sheet.name;
    }
  }
}

TEST(ScalarField, NeverFallsBelowZeroNorBeyondItsSamplesOnGridLines) {
  const ScalarField field({{{0, .2, .4, .6, 1}, {0, 1}}}, {0, 0, .05, .05, 1, 1, 1, 1, 0, 0});
  for (int i = 0; i <= 1000; ++i) {
    const double f = field.evaluate(i / 1000.0, .5).f;
    EXPECT_GE(f, 0);
    EXPECT_LE(f, 1 + 1e-15);
  }
}

TEST(ScalarField, DerivativesAreThoseOfItsValues) {
  const ScalarField field({{{0, .2, .4, .6, 1}, {0, .3, 1}}}, {1, 2, 5, 2, 3, 3, 4, 1, 2, 8, 2, 4, 2, 1, 1});
  constexpr double kStep = 1e-5;
  for (const double u : {.05, .31, .55, .9}) {
    for (const double v : {.1, .7}) {
      const auto at = field.evaluate2(u, v), right = field.evaluate2(u + kStep, v), up = field.evaluate2(u, v + kStep);
      const auto left = field.evaluate2(u - kStep, v), down = field.evaluate2(u, v - kStep);
      EXPECT_NEAR(at.fu, (right.f - left.f) / (2 * kStep), 1e-6);
      EXPECT_NEAR(at.fv, (up.f - down.f) / (2 * kStep), 1e-6);
      EXPECT_NEAR(at.fuu, (right.fu - left.fu) / (2 * kStep), 1e-5);
      EXPECT_NEAR(at.fuv, (up.fu - down.fu) / (2 * kStep), 1e-5);
      EXPECT_NEAR(at.fvv, (up.fv - down.fv) / (2 * kStep), 1e-5);
    }
  }
}

TEST(ScalarField, EqualSamplesTakeNoMemory) {
  const ScalarField field({{{0, .5, 1}, {0, 1}}}, std::vector<double>(6, 3.5));
  EXPECT_EQ(field.bytes(), 0u);
  EXPECT_EQ(field.evaluate2(.3, .3).f, 3.5);
}

TEST(Skeleton, TellsWhereRadiiChangeFasterThanCentresMoveApart) {
  for (const Sheet& sheet : test::sheets()) {
    EXPECT_EQ(test::build(sheet, false).steepest().slope, 0) << sheet.name;
    const Steepness steep = test::build(sheet, true).steepest();
    if (std::string(sheet.name) == "nearly degenerate") {  // 4 mm of radius over an edge of 2 mm
      EXPECT_GT(steep.slope, 1.5);
      EXPECT_LT(steep.u, .01);
    } else {
      EXPECT_LT(steep.slope, 1) << sheet.name;
    }
  }
  SkeletonGrid cone;
  cone.count = {1, 5};
  for (int j = 0; j < 5; ++j) {
    cone.points.emplace_back(.02 * j, 0, 0);
    cone.radius.push_back(.01 + .006 * j);
  }
  EXPECT_NEAR(Skeleton(cone).steepest().slope, .3, 1e-6);
}

TEST(Skeleton, RefusesWhatIsNoGrid) {
  SkeletonGrid grid;
  grid.count = {1, 1};
  grid.points = {{0, 0, 0}};
  grid.radius = {1};
  EXPECT_THROW(Skeleton{grid}, std::invalid_argument);
  grid.count = {1, 3};
  EXPECT_THROW(Skeleton{grid}, std::invalid_argument);
}

}  // namespace
}  // namespace hapticd::medial
