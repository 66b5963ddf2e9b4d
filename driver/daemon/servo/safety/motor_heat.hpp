// SPDX-License-Identifier: MIT
/// Estimates how hot the motors of one arm are from the commanded torques: each winding heats a housing, which gives
/// its heat to the air. So an arm needs no sensors of temperature, and a motor may give its stall torque until its
/// winding is near its limit.
#pragma once
#include <array>
#include <vector>

#include "description/scene.hpp"
#include "hapticd/device.h"

namespace hapticd::servo {

class MotorHeat {
 public:
  static constexpr double kMargin = 10;  ///< [K] derating of a motor begins this much below its limit

  /// [main] @param motors in the order of the joints; further joints have no model. All start at air temperature.
  explicit MotorHeat(const std::vector<scene::Motor>& motors);

  bool empty() const noexcept { return count_ == 0; }
  size_t count() const noexcept { return count_; }  ///< number of joints with a model of their motor

  /// [rt] Calculates how torques [N m] at the joints, held for dt [s], heat the motors.
  void heat(const double* torque, double dt) noexcept HSP_RT;

  /// Returns the share of every force that the hottest motor allows: 1 while it is cool, 0 at its limit.
  double factor() const noexcept { return factor_; }
  /// Returns the temperature [degC] of the winding that is nearest to its limit.
  double hottest() const noexcept { return hottest_; }
  /// True if a winding is more than 5 K beyond its limit. Then something other than forces heats it, such as gravity
  /// compensation.
  bool overheated() const noexcept { return overheated_; }
  /// [degC] temperature of one motor's winding
  double winding(size_t joint) const noexcept { return bodies_[joint].winding; }

 private:
  struct Bodies {
    scene::Motor motor;
    double winding = 0, housing = 0;  ///< [degC] temperatures
  };
  std::array<Bodies, HDV_MAX_JOINTS> bodies_{};
  size_t count_ = 0;
  double factor_ = 1, hottest_ = 0;
  bool overheated_ = false;
};

}  // namespace hapticd::servo
