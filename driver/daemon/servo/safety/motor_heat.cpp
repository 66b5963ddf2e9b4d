// SPDX-License-Identifier: MIT
#include "servo/safety/motor_heat.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

namespace {

constexpr double kCopper = 0.00393;  ///< [1/K] relative rise of the resistance of copper
constexpr double kRatedAt = 25;      ///< [degC] temperature at which data sheets give the resistance
/// [K] a winding this far above its limit is overheated; a held force alone never heats it so far
constexpr double kOvershoot = 5;
constexpr double kLongestHold = 0.1;  ///< [s] longest time of one torque; longer gaps cause other faults

}  // namespace

MotorHeat::MotorHeat(const std::vector<scene::Motor>& motors) : count_(std::min(motors.size(), bodies_.size())) {
  for (size_t i = 0; i < count_; ++i) bodies_[i] = {motors[i], motors[i].ambient, motors[i].ambient};
}

void MotorHeat::heat(const double* torque, double dt) noexcept HSP_RT {
  dt = std::clamp(dt, 0.0, kLongestHold);
  factor_ = 1;
  overheated_ = false;
  double least_room = HUGE_VAL;
  for (size_t i = 0; i < count_; ++i) {
    Bodies& b = bodies_[i];
    const scene::Motor& m = b.motor;
    const double current = std::isfinite(torque[i]) ? torque[i] / (m.ratio * m.torque_constant) : 0;
    const double power = m.resistance * (1 + kCopper * (b.winding - kRatedAt)) * current * current;
    const double to_housing = (b.winding - b.housing) / m.winding_housing;
    const double to_air = (b.housing - m.ambient) / m.housing_air;
    // heat capacity = time constant / thermal resistance; data sheets give these two
    b.winding += dt * (power - to_housing) * m.winding_housing / m.winding_time;
    b.housing += dt * (to_housing - to_air) * m.housing_air / m.housing_time;
    const double room = m.max_temperature - b.winding;
    factor_ = std::min(factor_, std::clamp(room / kMargin, 0.0, 1.0));
    overheated_ |= room < -kOvershoot;
    if (room >= least_room) continue;
    least_room = room;
    hottest_ = b.winding;
  }
}

}  // namespace hapticd::servo
