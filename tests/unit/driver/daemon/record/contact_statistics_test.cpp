// SPDX-License-Identifier: MIT
#include "record/contact_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::record {
namespace {

constexpr double kDt = 1e-3;

TEST(ContactStatistics, CountsDepthAndForceInContactAlone) {
  ContactStatistics s;
  s.add(false, -0.5, 99, kDt, 0);
  s.add(true, 0.001, 1, kDt, 0);
  s.add(true, 0.003, 2, kDt, 0);
  EXPECT_EQ(s.contactTicks(), 2u);
  EXPECT_NEAR(s.meanDepth(), 0.002, 1e-15);
  EXPECT_NEAR(s.stdDepth(), std::sqrt(2.0) * 1e-3, 1e-15);
  EXPECT_EQ(s.maxDepth(), 0.003);
  EXPECT_EQ(s.meanForce(), 1.5);
  EXPECT_EQ(s.maxForce(), 2);
}

TEST(ContactStatistics, KeepsASmallSpreadBesideALargeMeanOverALongRun) {
  ContactStatistics s;
  for (int i = 0; i < 1000000; ++i) s.add(true, 1.0 + (i % 2 == 0 ? 1e-9 : -1e-9), 0, kDt, 0);
  EXPECT_NEAR(s.stdDepth(), 1e-9, 1e-14);
}

TEST(ContactStatistics, FeelsFastChangesOfDepthAsBuzzAndSlowOnesNot) {
  ContactStatistics fast, slow;
  constexpr double kAmplitude = 1e-4;
  for (int i = 0; i < 10000; ++i) {
    fast.add(true, 0.01 + kAmplitude * std::sin(2 * M_PI * 200 * i * kDt), 0, kDt, 0);
    slow.add(true, 0.01 + kAmplitude * std::sin(2 * M_PI * 1 * i * kDt), 0, kDt, 0);
  }
  EXPECT_NEAR(fast.buzz(), kAmplitude / std::sqrt(2.0), 0.02 * kAmplitude);
  EXPECT_LT(slow.buzz(), 0.05 * kAmplitude);
}

TEST(ContactStatistics, DoesNotTakeAnImpactShorterThanAWindowForBuzz) {
  ContactStatistics s;
  for (int i = 0; i < 10; ++i) s.add(true, i * 1e-3, 0, kDt, 0);
  s.add(false, 0, 0, kDt, 0);
  EXPECT_EQ(s.buzz(), 0);
}

TEST(ContactStatistics, BooksStepTimesInMicroseconds) {
  ContactStatistics s;
  s.add(false, 0, 0, kDt, 2500);
  s.add(false, 0, 0, kDt, 0);
  EXPECT_EQ(s.stepUs().total(), 1u);
  EXPECT_EQ(s.stepUs().max(), 2.5);
}

TEST(ContactStatistics, StaysFiniteWhateverAShapeAnswers) {
  ContactStatistics s;
  s.add(true, 0.001, 1, kDt, 0);
  s.add(true, std::nan(""), 1, kDt, 0);
  s.add(true, 0.001, HUGE_VAL, kDt, 0);
  EXPECT_EQ(s.contactTicks(), 1u);
  EXPECT_EQ(s.meanDepth(), 0.001);
  EXPECT_EQ(s.maxForce(), 1);
}

}  // namespace
}  // namespace hapticd::record
