// SPDX-License-Identifier: MIT
#include "emulators/step_meter.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace hapticd::emulator {

double StepMeter::report(Nanoseconds now) {
  if (angle_ == 0) return 0;
  const uint64_t report = reports_++;
  if (report % kReportsAStep == 0) stepped_at_ = now;
  return report / kReportsAStep % 2 == 0 ? 0 : angle_;
}

void StepMeter::command(Nanoseconds now, const Currents& current) {
  int most = 0;
  for (size_t i = 0; i < current.size(); ++i) most = std::max(most, std::abs(current[i] - last_[i]));
  last_ = current;
  if (stepped_at_ == 0 || most < least_) return;
  took_us_.push_back(1e-3 * static_cast<double>(now - stepped_at_));
  stepped_at_ = 0;
}

void StepMeter::tell() const {
  if (took_us_.empty()) return;
  std::vector<double> sorted = took_us_;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double part) {
    return sorted[static_cast<size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  std::printf("latency p50 %.0f us, p90 %.0f us, of %zu steps\n", at(0.5), at(0.9), sorted.size());
}

}  // namespace hapticd::emulator
