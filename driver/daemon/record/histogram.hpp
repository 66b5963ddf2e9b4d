// SPDX-License-Identifier: MIT
/// A histogram of fixed size for times from 1 ns to about a minute. Adding a value is a real-time call; quantiles are
/// exact to 2 %.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::record {

/// The buckets divide each interval between two powers of two into 32 equal steps, for values from 2^-10 to 2^26 us.
class Histogram {
 public:
  static constexpr int kSteps = 32, kLowest = -10, kHighest = 26;
  static constexpr int kBuckets = (kHighest - kLowest) * kSteps;

  /// [rt] Counts one value; values below the range count in the first bucket, values above it in the last.
  void add(double value) noexcept HSP_RT {
    ++counts_[static_cast<size_t>(bucketOf(value))];
    ++total_;
    if (value > max_) max_ = value;
  }

  /// [any] Returns the value below which a share q of all values lies, at most max(); 0 if the histogram is empty.
  double quantile(double q) const noexcept {
    const double wanted = std::max(1.0, q * static_cast<double>(total_));
    uint64_t seen = 0;
    for (int i = 0; i < kBuckets; ++i) {
      seen += counts_[static_cast<size_t>(i)];
      if (total_ > 0 && static_cast<double>(seen) >= wanted) return std::min(middleOf(i), max_);
    }
    return 0;
  }

  double max() const noexcept { return max_; }
  uint64_t total() const noexcept { return total_; }
  uint64_t count(int bucket) const noexcept { return counts_[static_cast<size_t>(bucket)]; }

  /// Returns the lower edge of a bucket. edgeOf(kBuckets) is the upper edge of the last bucket.
  static double edgeOf(int bucket) noexcept {
    const double fraction = static_cast<double>(bucket % kSteps) / kSteps;
    return std::ldexp(1 + fraction, kLowest + bucket / kSteps);
  }

  /// [rt] Returns the number of the bucket for a value.
  static int bucketOf(double value) noexcept HSP_RT {
    if (!(value > 0)) return 0;
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);  // value = mantissa * 2^exponent, mantissa in [0.5, 1)
    const int step = static_cast<int>((2 * mantissa - 1) * kSteps);
    return std::clamp((exponent - 1 - kLowest) * kSteps + step, 0, kBuckets - 1);
  }

 private:
  static double middleOf(int bucket) noexcept { return 0.5 * (edgeOf(bucket) + edgeOf(bucket + 1)); }

  std::array<uint64_t, kBuckets> counts_{};
  uint64_t total_ = 0;
  double max_ = 0;
};

}  // namespace hapticd::record
