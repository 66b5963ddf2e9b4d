// SPDX-License-Identifier: MIT
#include "servo/loop/lockstep.hpp"

#include "link/link.hpp"

namespace hapticd::servo {

void Lockstep::before(double t) {
  constexpr double kPeriod = static_cast<double>(link::kSearchPeriod) * kSecondsPerNanosecond;
  constexpr double kRounding = 1e-9;  // [s] tolerance, so that 5 ms are exactly five ticks of 1 ms
  const bool due = !started_ || t - last_ >= kPeriod - kRounding;
  if (!due && !core_.needsSearch()) return;
  if (due) last_ = t;
  started_ = true;
  search_();
}

}  // namespace hapticd::servo
