// SPDX-License-Identifier: MIT
/// Finds positions that an arm cannot have. They show that the layout or the scale in the device file is wrong,
/// although every report is well formed.
#pragma once
#include <string>
#include <vector>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// What the device file says about the arm that sent the reports.
struct ArmFacts {
  size_t joints = 0;
  std::vector<double> limits;  ///< [rad] least and greatest position of each joint; empty if not given
  /// true if positions count from the position at power-on, so that only a calibration pose gives their zero
  bool zeroed = false;
  std::vector<double> max_torque;  ///< [N m] largest torque of each joint; empty if not given
  double max_speed = 100;          ///< [rad/s] greatest speed of a joint
  double least_rate = 0.57;        ///< no torque is sent if the reports arrive at less than this share of wire.rate
};

/// [main] Returns one line for each joint that leaves its limits or jumps faster than it can move, or "" if there is
/// none.
std::string implausible(const codec::Wire& wire, const ArmFacts& arm, const Decoded& decoded);

}  // namespace hapticd::capture
