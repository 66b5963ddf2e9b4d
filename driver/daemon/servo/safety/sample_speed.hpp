// SPDX-License-Identifier: MIT
/// How fast a tip went from one sample to the next, by the time at which each was measured: an encoder that lost its
/// count, or a packet that was misread, must not choose the force.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::servo {

class SampleSpeed {
 public:
  static constexpr double kAssumedPeriod = 2e-3;  ///< [s] between samples, if the arm does not say
  /// [s] A time stamp may be so far ahead of the time that the host saw pass, because packets wait in buffers. A clock
  /// that says more is not believed, since it would make a jump look slow.
  static constexpr double kAhead = 2e-3;

  /// [main] @param rate [Hz] of the arm's samples, 0: unknown  @param resolution [m] of a position, 0: unknown
  SampleSpeed(double rate, double resolution);

  /// [rt] Takes a new sample. Two of them may be delivered together and stamped as they arrive: they are never taken to
  /// be closer than a period of the arm. @param stamp_ns when it was measured, or 0  @param passed [s] that the host
  /// saw pass since the last one  @return [m/s]; 0 for the first
  double update(const Eigen::Vector3d& position, uint64_t stamp_ns, double passed) noexcept HSP_RT;

  /// [rt] There is a gap: the next sample is the first.
  void reset() noexcept HSP_RT { known_ = false; }

 private:
  double shortest_, resolution_;
  bool known_ = false;
  uint64_t stamp_ns_ = 0;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::servo
