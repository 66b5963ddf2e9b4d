// SPDX-License-Identifier: MIT
/// The time between two samples of an arm, for the estimators of velocity. An arm measures at its own rate, and a
/// sample waits for the next tick. So the times of ticks are up to a period wrong: an arm of 1000 Hz under a servo of
/// 1500 Hz would seem to move now 1.5 and now 0.75 times as fast as it does, and damping would buzz.
#pragma once
#include <algorithm>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::servo {

class SampleInterval {
 public:
  /// [s] Stamps may be this much farther apart than the ticks that saw the samples. More is not believed.
  static constexpr double kAhead = 2e-3;

  /// [rt] Takes the stamp of a new sample and returns the time [s] since the sample before.
  /// @param stamp_ns time of the measurement; 0: unknown
  /// @param passed [s] between the ticks that saw the two samples. It counts where stamps do not advance, or hardly do:
  /// such samples waited in a buffer, and were stamped together. The next stamp counts from there
  double update(uint64_t stamp_ns, double passed) noexcept HSP_RT {
    const uint64_t before = stamp_ns_;
    stamp_ns_ = stamp_ns;
    if (before == 0 || stamp_ns < before) {
      ahead_ = 0;
      return passed;
    }
    const double measured = static_cast<double>(stamp_ns - before) * 1e-9 - ahead_;
    ahead_ = measured < passed / 4 ? std::min(passed - measured, kAhead) : 0;
    return ahead_ > 0 ? passed : std::min(measured, passed + kAhead);
  }

 private:
  uint64_t stamp_ns_ = 0;
  double ahead_ = 0;  // [s] by how much more the last samples counted than their stamps advanced
};

}  // namespace hapticd::servo
