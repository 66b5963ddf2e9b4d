// SPDX-License-Identifier: MIT
#include "servo/velocity/sample_interval.hpp"

#include <gtest/gtest.h>

namespace hapticd::servo {
namespace {

TEST(SampleInterval, IsThatOfTheStamps) {
  SampleInterval interval;
  interval.update(1'000'000, 1);
  EXPECT_NEAR(interval.update(2'000'000, 1.4e-3), 1e-3, 1e-15) << "a tick came late";
  EXPECT_NEAR(interval.update(4'000'000, 1e-3), 2e-3, 1e-15) << "no tick saw the sample between";
}

TEST(SampleInterval, IsThatOfTheTicksWithoutStamps) {
  SampleInterval interval;
  EXPECT_EQ(interval.update(0, 7), 7);
  EXPECT_EQ(interval.update(0, 1e-3), 1e-3);
  EXPECT_EQ(interval.update(5'000'000, 1e-3), 1e-3) << "the one before had none";
  EXPECT_EQ(interval.update(4'000'000, 2e-3), 2e-3) << "a clock that goes backward";
}

TEST(SampleInterval, BelievesNoClockThatRunsAway) {
  SampleInterval interval;
  interval.update(1, 1);
  EXPECT_EQ(interval.update(UINT64_MAX, 1e-3), 1e-3 + SampleInterval::kAhead);
}

TEST(SampleInterval, OfSamplesThatWereStampedTogetherIsThatOfTheTicks) {
  SampleInterval interval;
  interval.update(1'000'000, 1);
  EXPECT_EQ(interval.update(1'001'000, 0.25e-3), 0.25e-3);
}

/// Such as samples that come in pairs, or stamps of whole milliseconds.
TEST(SampleInterval, OfAHandThatGoesOnStaysTheSameWhereSeveralSamplesHaveOneStamp) {
  for (const uint64_t together : {2, 4}) {
    SampleInterval interval;
    for (uint64_t i = 1; i < 100; ++i) {
      const uint64_t stamp = 500'000 * together * (1 + i / together) + i % together;
      const double since = interval.update(stamp, 0.5e-3);
      if (i > together) {
        EXPECT_NEAR(since, 0.5e-3, 1e-8) << i;
      }
    }
  }
}

}  // namespace
}  // namespace hapticd::servo
