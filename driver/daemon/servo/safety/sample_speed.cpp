// SPDX-License-Identifier: MIT
#include "servo/safety/sample_speed.hpp"

#include <algorithm>

namespace hapticd::servo {

SampleSpeed::SampleSpeed(double rate, double resolution)
    : shortest_(rate > 0 ? 1 / rate : kAssumedPeriod), resolution_(resolution) {}

double SampleSpeed::update(const Eigen::Vector3d& position, uint64_t stamp_ns, double passed) noexcept HSP_RT {
  const bool stamped = stamp_ns > stamp_ns_;
  const double measured = stamped ? static_cast<double>(stamp_ns - stamp_ns_) * 1e-9 : passed;
  const double seconds = std::max(shortest_, std::min(measured, passed + kAhead));
  const double moved = (position - position_).norm() - resolution_;  // one step of the encoder is not yet motion
  const double speed = known_ ? std::max(0.0, moved) / seconds : 0;
  known_ = true;
  stamp_ns_ = stamp_ns;
  position_ = position;
  return speed;
}

}  // namespace hapticd::servo
