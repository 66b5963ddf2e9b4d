// SPDX-License-Identifier: MIT
#include "cli/recording/tick_times.hpp"

namespace hapticd::cli {

TickTimes::TickTimes(const record::Recording& recording) : ticks_(recording.stream("ticks")) {
  if (ticks_ == nullptr) return;
  tick_ = ticks_->find("tick"), time_ = ticks_->find("t");
}

double TickTimes::of(double tick) {
  if (tick_ == nullptr || time_ == nullptr || ticks_->rows() == 0) return 0;
  while (row_ + 1 < ticks_->rows() && ticks_->number(row_, *tick_) < tick) ++row_;
  return ticks_->number(row_, *time_);
}

}  // namespace hapticd::cli
