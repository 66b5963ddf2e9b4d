// SPDX-License-Identifier: MIT
/// How hot the motors of one arm are, from the torques they are asked for: a winding that heats a housing that gives
/// its heat to the air. No sensor is needed, and stall torque can be used for as long as the copper bears it.
#pragma once
#include <array>
#include <vector>

#include "description/scene.hpp"
#include "hapticd/device.h"

namespace hapticd::servo {

class MotorHeat {
 public:
  static constexpr double kMargin = 10;  ///< [K] below its limit, at which derating of a motor begins

  /// [main] @param motors in the order of the joints; joints beyond have none. All start at the air's temperature.
  explicit MotorHeat(const std::vector<scene::Motor>& motors);

  bool empty() const noexcept { return count_ == 0; }
  size_t count() const noexcept { return count_; }  ///< joints whose motors are modelled

  /// [rt] The torques [N m] at the joints are held for dt [s].
  void heat(const double* torque, double dt) noexcept HSP_RT;

  /// The share of every force that the hottest motor allows: 1 while cool, 0 at its limit.
  double factor() const noexcept { return factor_; }
  /// [degC] temperature of the winding nearest to its limit.
  double hottest() const noexcept { return hottest_; }
  /// A winding is beyond its limit: something other than forces heats it, such as gravity compensation.
  bool overheated() const noexcept { return overheated_; }
  double winding(size_t joint) const noexcept { return bodies_[joint].winding; }  ///< [degC]

 private:
  struct Bodies {
    scene::Motor motor;
    double winding = 0, housing = 0;  ///< [degC]
  };
  std::array<Bodies, HDV_MAX_JOINTS> bodies_{};
  size_t count_ = 0;
  double factor_ = 1, hottest_ = 0;
  bool overheated_ = false;
};

}  // namespace hapticd::servo
