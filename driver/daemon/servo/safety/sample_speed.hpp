// SPDX-License-Identifier: MIT
/// Calculates the speed of a tip between two samples from the times at which they were measured. The speed shows jumps:
/// after an encoder lost its count, or a packet was misread, the wrong position must not cause a force.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::servo {

class SampleSpeed {
 public:
  static constexpr double kAssumedPeriod = 2e-3;  ///< [s] time between samples, if the arm reports no rate
  /// [s] The time between two stamps may be this much longer than the time on the host, because packets wait in
  /// buffers. A longer time is not believed, because it would make a jump look slow.
  static constexpr double kAhead = 2e-3;

  /// [main] @param rate [Hz] of the arm's samples, 0: unknown  @param resolution [m] of its position, 0: unknown
  SampleSpeed(double rate, double resolution);

  /// [rt] Takes a new sample and returns the speed [m/s], 0 for the first sample. Two samples may arrive and get their
  /// time stamps almost at once. So the time between two samples counts as at least one period of the arm.
  /// @param stamp_ns time of the measurement; 0: unknown
  /// @param passed [s] time on the host since the last sample
  double update(const Eigen::Vector3d& position, uint64_t stamp_ns, double passed) noexcept HSP_RT;

  /// [rt] Called after a gap: the next sample counts as the first.
  void reset() noexcept HSP_RT { known_ = false; }

 private:
  double shortest_, resolution_;
  bool known_ = false;
  uint64_t stamp_ns_ = 0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::servo
