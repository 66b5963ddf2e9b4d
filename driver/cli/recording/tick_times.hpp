// SPDX-License-Identifier: MIT
/// The times of the ticks of a recording.
#pragma once
#include <cstdint>

#include "record/recording.hpp"

namespace hapticd::cli {

/// [main] The time of ticks, which are asked for in their order.
class TickTimes {
 public:
  explicit TickTimes(const record::Recording& recording);
  /// Returns the time of the tick [s] since the first one, or of the next tick that is in the recording.
  double of(double tick);

 private:
  const record::RecordedStream* ticks_;
  const record::Column *tick_ = nullptr, *time_ = nullptr;
  uint64_t row_ = 0;
};

}  // namespace hapticd::cli
