// SPDX-License-Identifier: MIT
/// Positions that an arm cannot have: a layout or a scale that is wrong reads every report as a good one.
#pragma once
#include <string>
#include <vector>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// What the device file says about the arm that sent the reports.
struct ArmFacts {
  size_t joints = 0;
  std::vector<double> limits;      ///< least, greatest [rad] of each joint; empty: not given
  bool zeroed = false;             ///< positions count from where the arm was switched on, and a pose gives their zero
  std::vector<double> max_torque;  ///< [N m] of each joint; empty: not given
  double max_speed = 100;          ///< [rad/s] of a joint
  double least_rate = 0.57;        ///< share of wire.rate: with fewer reports no torque is sent
};

/// [main] One line for each joint that leaves its limits, or jumps faster than it can move; "" if none does.
std::string implausible(const codec::Wire& wire, const ArmFacts& arm, const Decoded& decoded);

}  // namespace hapticd::capture
