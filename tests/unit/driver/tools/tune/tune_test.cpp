// SPDX-License-Identifier: MIT
/// Choosing among measured settings, and comparing answers; what is measured is tried in tests/e2e/tune.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tune/motion.hpp"
#include "tune/search.hpp"

namespace hapticd::tune {
namespace {

Candidate candidate(double p50_ns, double foot_m, double force_n = 0) {
  Candidate c;
  c.cost.p50_ns = p50_ns;
  c.cost.p50_low_ns = p50_ns, c.cost.p50_high_ns = p50_ns * (1 + kCostNoise);
  c.cost.p99_ns = 2 * p50_ns;
  c.error.foot_m = foot_m;
  c.error.force_n = force_n;
  return c;
}

TEST(Front, HoldsWhatNoOtherBeats) {
  std::vector<Candidate> all = {candidate(100, 1e-6), candidate(200, 1e-8), candidate(300, 1e-7), candidate(50, 1e-3)};
  markFront(all);
  EXPECT_TRUE(all[0].on_front);
  EXPECT_TRUE(all[1].on_front);
  EXPECT_FALSE(all[2].on_front);  // dearer and worse than the second
  EXPECT_TRUE(all[3].on_front);
}

TEST(Front, TakesTimesWithinTheNoiseAndErrorsOfRoundingForEqual) {
  std::vector<Candidate> all = {candidate(100, 1e-12), candidate(98, 1e-14)};
  markFront(all);
  EXPECT_TRUE(all[0].on_front);
  EXPECT_TRUE(all[1].on_front);
  EXPECT_TRUE(alike(all[0], all[1]));
}

TEST(Front, IsNotLeftByBeingMoreAccurateInForceAlone) {
  std::vector<Candidate> all = {candidate(100, 1e-6, 0.5), candidate(120, 1e-6, 0.1)};
  markFront(all);
  EXPECT_TRUE(all[0].on_front);
  EXPECT_TRUE(all[1].on_front);
}

/// What the table says: no other setting is as accurate as one of the front and clearly cheaper.
TEST(Front, KeepsItsWordOverRandomCostsAndErrors) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> few(1, 6), many(1, 40);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Candidate> all;
    for (int i = many(random); i > 0; --i) {
      all.push_back(candidate(100 * few(random), 1e-6 * few(random), 0.1 * few(random)));
      all.back().cost.p50_high_ns *= 1 + 0.2 * few(random);
    }
    markFront(all);
    size_t front = 0;
    for (const Candidate& c : all) {
      front += c.on_front ? 1 : 0;
      const bool beaten = std::any_of(all.begin(), all.end(), [&](const Candidate& other) {
        return clearlyCheaper(other, c) && other.error.foot_m <= c.error.foot_m &&
               other.error.force_n <= c.error.force_n;
      });
      EXPECT_FALSE(c.on_front && beaten);
    }
    EXPECT_GT(front, 0u);
  }
}

TEST(Choice, NamesNoParameterWithoutEffect) {
  std::vector<Candidate> all = {candidate(100, 1e-9), candidate(51, 1e-6), candidate(50, 1e-6), candidate(52, 1e-6),
                                candidate(20, 1e-3)};
  const std::vector<Choice> choices = {{0, 0, 0}, {1, 2, 0}, {1, 1, 1}, {1, 0, 0}, {2, 0, 0}};
  for (size_t i = 0; i < all.size(); ++i) all[i].choice = choices[i];
  markFront(all);
  ASSERT_TRUE(all[3].on_front);
  EXPECT_EQ(simplest(all, 2), 3u);
  EXPECT_EQ(simplest(all, 0), 0u);
  EXPECT_EQ(simplest(all, 4), 4u);
  Goal goal;
  goal.tolerance_m = 1e-5;
  EXPECT_EQ(choose(all, goal), (std::pair<size_t, bool>(3, true)));
  all[3].cost.p50_low_ns = 52.6, all[2].cost.p50_high_ns = 52.5;  // now it is clearly dearer
  EXPECT_EQ(simplest(all, 2), 1u);
}

TEST(Cost, OfTwoMeasurementsIsAnIntervalThatHoldsBoth) {
  Cost cost = candidate(100, 0).cost;
  widen(cost, candidate(130, 0).cost);
  EXPECT_EQ(cost.p50_ns, 100);
  EXPECT_EQ(cost.p50_low_ns, 100);
  EXPECT_GE(cost.p50_high_ns, 130);
  widen(cost, candidate(90, 0).cost);
  EXPECT_EQ(cost.p50_ns, 90);
  EXPECT_GE(cost.p50_high_ns, 130);
}

TEST(Choice, IsTheCheapestWithinHalfOfTheTolerances) {
  const std::vector<Candidate> all = {candidate(400, 1e-9), candidate(100, 0.9e-6), candidate(200, 0.4e-6),
                                      candidate(150, 1e-9, 0.2)};
  const auto [index, reached] = choose(all, Goal{});
  EXPECT_EQ(index, 2u);
  EXPECT_TRUE(reached);
}

TEST(Choice, StaysWithTheSceneUnlessAnotherIsCheaperBeyondTheNoise) {
  const std::vector<Candidate> all = {candidate(100, 1e-9), candidate(97, 1e-9)};
  EXPECT_EQ(choose(all, Goal{}).first, 0u);
}

TEST(Choice, SaysWhenNothingReachesTheToleranceAndTakesTheMostAccurate) {
  const std::vector<Candidate> all = {candidate(100, 1e-3), candidate(900, 1e-5), candidate(50, 1e-2)};
  const auto [index, reached] = choose(all, Goal{});
  EXPECT_EQ(index, 1u);
  EXPECT_FALSE(reached);
}

TEST(Choice, OfABudgetIsTheMostAccurateThatFits) {
  Goal goal;
  goal.budget_ns = 500;
  const std::vector<Candidate> all = {candidate(100, 1e-6), candidate(240, 1e-8), candidate(300, 1e-12)};
  const auto [index, reached] = choose(all, goal);
  EXPECT_EQ(index, 1u);
  EXPECT_TRUE(reached);
}

TEST(Choice, OfABudgetPaysNothingForErrorsThatAreRounding) {
  Goal goal;
  goal.budget_ns = 1000;
  EXPECT_EQ(choose({candidate(100, 8e-12), candidate(200, 0)}, goal).first, 0u);
  EXPECT_EQ(choose({candidate(200, 0), candidate(100, 8e-12)}, goal).first, 1u);
}

Answer answerAt(double x, double depth) {
  Answer answer;
  answer.point = {x, 0, 0};
  answer.normal = {1, 0, 0};
  answer.force = {0, 0, 0};
  answer.depth = depth;
  answer.traced = true;
  return answer;
}

TEST(Comparison, CountsAFootThatIsFartherAndNotOneThatIsEquallyNear) {
  tune::Run run, reference;
  run.models = reference.models = 1;
  run.answers = {answerAt(0.1, 0.001), answerAt(0.2, 0.001)};
  reference.answers = {answerAt(-0.1, 0.001), answerAt(0.200002, 0.001)};
  const Difference difference = compare(run, reference);
  EXPECT_NEAR(difference.foot_m, 2e-6, 1e-12);
  EXPECT_EQ(difference.ambiguous, 1u);
  reference.answers[0].depth = 0.002;  // now the first foot is a millimetre off, and another point
  EXPECT_NEAR(compare(run, reference).foot_m, 0.2, 1e-12);
}

TEST(Comparison, TakesALostTrackForTheWorstError) {
  tune::Run run, reference;
  run.models = reference.models = 1;
  run.answers = {Answer{}};
  run.answers[0].force.setZero();
  reference.answers = {answerAt(0, 0.001)};
  EXPECT_EQ(compare(run, reference).untraced, 1u);
  EXPECT_EQ(compare(run, reference).geometry(), 1);
}

TEST(Comparison, DoesNotAskForAFootThatIsFarAway) {
  tune::Run run, reference;
  run.models = reference.models = 1;
  run.answers = {Answer{}};
  run.answers[0].force.setZero();
  reference.answers = {answerAt(0, -0.15)};
  EXPECT_EQ(compare(run, reference, 0.01).untraced, 0u) << "a smaller radius leaves it out on purpose";
  reference.answers = {answerAt(0, -0.005)};
  EXPECT_EQ(compare(run, reference, 0.01).untraced, 1u);
}

TEST(Motion, AtAnotherRateGoesThroughTheSamePlaces) {
  std::vector<Eigen::Vector3d> position;
  for (int i = 0; i < 500; ++i) position.emplace_back(std::sin(0.02 * i), std::cos(0.02 * i), 0.001 * i);
  const Motion motion = motionThrough(position, 1e-3), fine = resampled(motion, 4000);
  for (size_t i = 8; i + 8 < position.size(); ++i) {
    EXPECT_NEAR((fine.position[4 * i] - position[i]).norm(), 0, 1e-9);
    EXPECT_NEAR(
        (motion.velocity[i] - Eigen::Vector3d(20 * std::cos(0.02 * double(i)), -20 * std::sin(0.02 * double(i)), 1))
            .norm(),
        0, 0.02);
  }
}

}  // namespace
}  // namespace hapticd::tune
