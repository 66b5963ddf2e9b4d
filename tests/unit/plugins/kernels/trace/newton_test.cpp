// SPDX-License-Identifier: MIT
#include "kernels/trace/newton.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "shapes.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr int kMostEvaluations = 12;

Vector3d anyProbe(std::mt19937& random, double spread) {
  std::uniform_real_distribution<double> place(-spread, spread);
  return Vector3d(0.05 + place(random), 0.05 + place(random), place(random));
}

/// A point of the patch and a probe at most 2.5 mm off it along its normal: the point is the probe's foot.
struct Pair {
  Array2d uv;
  Vector3d foot, probe;
};
Pair anyPair(const Patch& patch, std::mt19937& random) {
  std::uniform_real_distribution<double> fraction(0.05, 0.95), depth(-2.5e-3, 2.5e-3);
  Pair pair;
  pair.uv = patch.lo + Array2d(fraction(random), fraction(random)) * (patch.hi - patch.lo);
  spline::SurfacePoint E;
  patch.surface.evaluate1(pair.uv[0], pair.uv[1], E);
  pair.foot = E.S;
  pair.probe = E.S + depth(random) * E.Su.cross(E.Sv).normalized();
  return pair;
}

TEST(Newton, DistanceNeverIncreasesWhateverTheProbeDoes) {
  std::mt19937 random(1);
  for (int model = 0; model < 20; ++model) {
    const Model one({randomPatch(random, 8, model % 2 == 1)});
    const Patch& patch = one.patch(0);
    Iterate at;
    at.uv = 0.5 * (patch.lo + patch.hi);
    LocalFoot foot;
    newtonFoot(patch, Vector3d(0.05, 0.05, 0), at, 1e-9, kMostEvaluations, foot);
    for (int tick = 0; tick < 2000; ++tick) {
      const Vector3d p = anyProbe(random, tick % 3 == 0 ? 1.0 : 0.06);
      const double before = (at.E.S - p).norm();
      newtonFoot(patch, p, at, 1e-9, kMostEvaluations, foot);
      ASSERT_LE(foot.evaluations, kMostEvaluations);
      ASSERT_LE((at.E.S - p).norm(), before * (1 + 1e-13) + 1e-14);
      ASSERT_LE(foot.distance, before * (1 + 1e-12) + 1e-10);
      ASSERT_TRUE(((foot.uv >= patch.lo) && (foot.uv <= patch.hi)).all());
      spline::SurfacePoint E;
      patch.surface.evaluate2(at.uv[0], at.uv[1], E);
      ASSERT_EQ((E.S - at.E.S).norm(), 0) << "the kept point is not the point of its parameters";
    }
  }
}

TEST(Newton, FindsANearFootToFarBelowTheToleranceInOneEvaluation) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> off(-3e-4, 3e-4);
  int evaluations = 0, feet = 0;
  for (int model = 0; model < 20; ++model) {
    const Model one({randomPatch(random, 8, model % 2 == 1)});
    const Patch& patch = one.patch(0);
    for (int i = 0; i < 500; ++i) {
      const Pair pair = anyPair(patch, random);
      Iterate at;
      at.uv = (pair.uv + Array2d(off(random), off(random)) * 10 * (patch.hi - patch.lo)).max(patch.lo).min(patch.hi);
      const LocalFoot foot = newtonFoot(patch, pair.probe, at, 1e-9, kMostEvaluations);
      ASSERT_TRUE(foot.converged);
      EXPECT_LT((foot.S - pair.foot).norm(), 1e-9);
      EXPECT_LE(foot.residual, 1e-9);
      EXPECT_NEAR(foot.distance, (foot.S - pair.probe).norm(), 1e-15);
      evaluations += foot.evaluations - 1;  // the first one is that of the start
      ++feet;
    }
  }
  EXPECT_LT(evaluations, 1.1 * feet);
}

TEST(Newton, ToleranceZeroGivesAllDigitsThereAre) {
  std::mt19937 random(3);
  const Model one({randomPatch(random)});
  for (int i = 0; i < 500; ++i) {
    const Pair pair = anyPair(one.patch(0), random);
    Iterate at;
    at.uv = pair.uv + 1e-3;
    const LocalFoot foot = newtonFoot(one.patch(0), pair.probe, at, 0, kMostEvaluations);
    EXPECT_LT((foot.S - pair.foot).norm(), 1e-15);
  }
}

TEST(Newton, ARestingProbeCostsNoEvaluation) {
  std::mt19937 random(4);
  const Model one({randomPatch(random)});
  const Pair pair = anyPair(one.patch(0), random);
  Iterate at;
  at.uv = pair.uv;
  LocalFoot foot;
  newtonFoot(one.patch(0), pair.probe, at, 1e-9, kMostEvaluations, foot);
  newtonFoot(one.patch(0), pair.probe + Vector3d(1e-10, 0, 0), at, 1e-9, kMostEvaluations, foot);
  EXPECT_EQ(foot.evaluations, 0);
  EXPECT_LT((foot.S - pair.foot).norm(), 1e-9);
}

TEST(Newton, SmallBudgetsAreKept) {
  std::mt19937 random(5);
  const Model one({randomPatch(random)});
  for (int budget = 1; budget < 5; ++budget) {
    Iterate at;
    at.uv = one.patch(0).lo;
    for (int i = 0; i < 200; ++i)
      EXPECT_LE(newtonFoot(one.patch(0), anyProbe(random, 0.1), at, 1e-9, budget).evaluations, budget);
  }
}

TEST(Newton, HugeAndMeaninglessProbesLeaveAPointOfThePatch) {
  std::mt19937 random(6);
  const Model one({randomPatch(random)});
  const Patch& patch = one.patch(0);
  Iterate at;
  at.uv = 0.5 * (patch.lo + patch.hi);
  for (const double far :
       {1e10, 1e100, 1e149, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    newtonFoot(patch, Vector3d(far, -far, far), at, 1e-9, kMostEvaluations);
    EXPECT_TRUE(((at.uv >= patch.lo) && (at.uv <= patch.hi)).all()) << far;
    EXPECT_TRUE(at.E.S.allFinite()) << far;
  }
  const Pair pair = anyPair(patch, random);
  LocalFoot foot;
  for (int tick = 0; tick < 5; ++tick) newtonFoot(patch, pair.probe, at, 1e-9, kMostEvaluations, foot);
  EXPECT_LE(foot.distance, (at.E.S - pair.probe).norm() + 1e-9);
  EXPECT_TRUE(foot.S.allFinite());
}

/// One call of a warm-step kernel from `start`.
struct StepOutcome {
  WarmStepResult result = WarmStepResult::kNoStep;
  LocalFoot foot;
};
StepOutcome runWarmStep(spline::Instructions instructions, const Patch& patch, const Array2d& start,
                        const Vector3d& p) {
  const WarmStepKernels& kernels = warmStepKernels(instructions);
  Iterate at;
  at.uv = start;
  StepOutcome outcome;
  startNewton(patch, at, outcome.foot);
  kernels.forms(at.E.S.data(), at.state);
  outcome.result = kernels.step(p.data(), 1e-18, at.uv.data(), at.E.S.data(), at.state, outcome.foot.uv.data());
  return outcome;
}

TEST(Newton, EveryInstructionSetFindsTheSameFoot) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.02, 0.02);
  int found = 0;
  for (int model = 0; model < 10; ++model) {
    const Model one({randomPatch(random, 8, model % 2 == 1)});
    const Patch& patch = one.patch(0);
    for (int i = 0; i < 200; ++i) {
      const Pair pair = anyPair(patch, random);
      const Array2d start = (pair.uv + Array2d(off(random), off(random))).max(patch.lo).min(patch.hi);
      const StepOutcome fast = runWarmStep(spline::Instructions::kFastest, patch, start, pair.probe);
      const StepOutcome plain = runWarmStep(spline::Instructions::kPortable, patch, start, pair.probe);
      ASSERT_EQ(fast.result, plain.result);
      if (fast.result != WarmStepResult::kFoot) continue;
      ++found;
      EXPECT_LT((fast.foot.uv - plain.foot.uv).abs().maxCoeff(), 1e-13);
      EXPECT_LT((fast.foot.S - plain.foot.S).norm(), 1e-13);
      EXPECT_LT((fast.foot.normal - plain.foot.normal).norm(), 1e-13);
      EXPECT_NEAR(fast.foot.distance, plain.foot.distance, 1e-15);
      EXPECT_NEAR(fast.foot.height, plain.foot.height, 1e-15);
    }
  }
  EXPECT_GT(found, 1000);
}

TEST(Newton, TheNormalIsThatOfTheFootAndTheHeightIsMeasuredAlongIt) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> off(-0.02, 0.02);
  for (int model = 0; model < 10; ++model) {
    const Model one({randomPatch(random, 8, model % 2 == 1)});
    const Patch& patch = one.patch(0);
    for (int i = 0; i < 200; ++i) {
      const Pair pair = anyPair(patch, random);
      Iterate at;
      at.uv = (pair.uv + Array2d(off(random), off(random))).max(patch.lo).min(patch.hi);
      const LocalFoot foot = newtonFoot(patch, pair.probe, at, 1e-9, kMostEvaluations);
      if (foot.sides != 0) continue;
      ASSERT_TRUE(foot.regular);
      EXPECT_LT((foot.normal - patch.normalAt(foot.uv)).norm(), 1e-7) << "as 1 nm on a radius of 10 mm";
      EXPECT_NEAR(foot.normal.norm(), 1, 1e-12);
      EXPECT_NEAR(foot.height, (pair.probe - foot.S).dot(foot.normal), 1e-15);
    }
  }
}

TEST(Newton, AnIterateThatIsSetAnewStartsFromItsParameters) {
  std::mt19937 random(9);
  const Model one({randomPatch(random)});
  const Patch& patch = one.patch(0);
  const Pair here = anyPair(patch, random), there = anyPair(patch, random);
  Iterate at;
  at.uv = here.uv;
  newtonFoot(patch, here.probe, at, 1e-9, kMostEvaluations);
  at.uv = there.uv;
  at.known = Iterate::Known::kParameters;
  EXPECT_LT((newtonFoot(patch, there.probe, at, 1e-9, kMostEvaluations).S - there.foot).norm(), 1e-9);
}

TEST(Newton, TheCommonTickIsNotTriedWhereTangentsSpanNoPlaneOrTheProbeIsAtACentre) {
  const Model sphere = solid("sphere");
  const Patch& patch = sphere.patch(0);
  const Array2d middle = 0.5 * (patch.lo + patch.hi);
  EXPECT_EQ(runWarmStep(spline::Instructions::kFastest, patch, middle, Vector3d(1e-4, 2e-4, 0)).result,
            WarmStepResult::kNoStep);
  spline::SurfaceData flat;
  flat.degree = {1, 1};
  flat.knots[0] = flat.knots[1] = {0, 0, 1, 1};
  flat.points = {{0, 0, 0}, {0.05, 0, 0}, {0.1, 0, 0}, {0.15, 0, 1e-8}};
  const Model needle({flat});
  EXPECT_EQ(runWarmStep(spline::Instructions::kFastest, needle.patch(0), {0.5, 0.5}, Vector3d(0.06, 0, 0)).result,
            WarmStepResult::kNoStep);
}

}  // namespace
}  // namespace hapticd::trace
