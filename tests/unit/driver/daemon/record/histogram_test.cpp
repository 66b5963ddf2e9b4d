// SPDX-License-Identifier: MIT
#include "record/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace hapticd::record {
namespace {

TEST(Histogram, IsEmptyAtFirst) {
  const Histogram h;
  EXPECT_EQ(h.total(), 0u);
  EXPECT_EQ(h.quantile(0.5), 0);
  EXPECT_EQ(h.max(), 0);
}

TEST(Histogram, AgreesWithSortedValuesWithinTwoPercent) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> times(1.0, 2.0);
  std::vector<double> values(20000);
  Histogram h;
  for (double& value : values) h.add(value = times(random));
  std::sort(values.begin(), values.end());
  for (const double q : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const double exact = values[static_cast<size_t>(q * 20000) - 1];
    EXPECT_NEAR(h.quantile(q), exact, 0.02 * exact) << q;
  }
  EXPECT_EQ(h.max(), values.back());
}

TEST(Histogram, CountsAValueInTheBucketThatHoldsIt) {
  for (int bucket = 0; bucket < Histogram::kBuckets; ++bucket) {
    const double low = Histogram::edgeOf(bucket), high = Histogram::edgeOf(bucket + 1);
    Histogram h;
    h.add(low);
    h.add(0.5 * (low + high));
    EXPECT_EQ(h.count(bucket), 2u) << bucket;
  }
}

TEST(Histogram, KeepsWhatIsOutOfRangeAtItsEnds) {
  Histogram h;
  for (const double value : {0.0, -5.0, std::numeric_limits<double>::quiet_NaN(), 1e-30}) h.add(value);
  EXPECT_EQ(h.count(0), 4u);
  h.add(1e30);
  EXPECT_EQ(h.count(Histogram::kBuckets - 1), 1u);
  EXPECT_EQ(h.total(), 5u);
  EXPECT_EQ(h.max(), 1e30);
}

TEST(Histogram, HasQuantilesThatGrowAndNeverPassTheMaximum) {
  Histogram h;
  for (int i = 1; i <= 1000; ++i) h.add(i * 0.37);
  double last = 0;
  for (double q = 0; q <= 1.0; q += 0.01) {
    EXPECT_GE(h.quantile(q), last);
    last = h.quantile(q);
  }
  EXPECT_LE(h.quantile(1), h.max());
}

}  // namespace
}  // namespace hapticd::record
