// SPDX-License-Identifier: MIT
/// Finds a tip that swings faster than any hand moves it, as an arm does whose loop is not stable.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::servo {

/// Watches how often a tip turns round.
class Swing {
 public:
  static constexpr double kSwing = 1e-3;  ///< [m] a turn after a shorter way does not count: a tremor, or a texture
  static constexpr size_t kTurns = 12;    ///< no hand turns so often along one axis
  static constexpr double kWithin = 0.5;  ///< [s] in this time

  /// [rt] Adds the tip [m] of one tick. @param t [s] time of the run
  void add(double t, const Eigen::Vector3d& tip) noexcept HSP_RT {
    for (size_t i = 0; i < axes_.size(); ++i) add(t, tip[static_cast<Eigen::Index>(i)], axes_[i]);
  }

  /// [Hz] The fastest swing that no hand makes; 0 if there was none.
  double fastest() const noexcept { return fastest_; }

 private:
  struct Axis {
    bool known = false;
    int way = 0;                             // 1 or -1: the tip goes up or down along this axis; 0: not known yet
    double end = 0;                          // [m] the farthest place on this way
    std::array<double, kTurns> turned_at{};  // [s] times of the last turns
    uint64_t turns = 0;
  };

  void add(double t, double x, Axis& axis) noexcept HSP_RT {
    if (!axis.known) axis.end = x;
    axis.known = true;
    if (axis.way == 0 && std::abs(x - axis.end) > kSwing) axis.way = x > axis.end ? 1 : -1;
    if (axis.way * (axis.end - x) > kSwing) {
      axis.way = -axis.way;
      double& oldest = axis.turned_at[axis.turns % kTurns];
      if (axis.turns++ >= kTurns && t - oldest < kWithin) fastest_ = std::max(fastest_, 0.5 * kTurns / (t - oldest));
      oldest = t;
    }
    if (axis.way * (x - axis.end) > 0) axis.end = x;
  }

  std::array<Axis, 3> axes_;
  double fastest_ = 0;
};

}  // namespace hapticd::servo
