// SPDX-License-Identifier: MIT
#include "servo/safety/held_command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hapticd::servo {

namespace {

/// [Hz] At these rates or faster, the next tick or sample comes soon enough for the full force.
constexpr double kServoRateInFull = 1 / kHeldInFull, kArmRateInFull = 2 / kHeldInFull;

}  // namespace

double longestHeld(double servo_rate, double arm_rate) {
  const double tick = 1 / servo_rate, samples = arm_rate > 0 ? 2 / arm_rate : 0;
  return std::max(tick, samples);
}

double shareHeld(double held) {
  if (held <= kHeldInFull) return 1;
  const double shorter = kHeldForDistance / held;
  return std::min(kHeldInFull / held, shorter * shorter);
}

double mostForceAt(double servo_rate, double arm_rate, double device_force) {
  const double share = shareHeld(longestHeld(servo_rate, arm_rate));
  return share < 1 ? share * std::max(device_force, kReckonedForce) : HUGE_VAL;
}

std::string describeSlow(double servo_rate, double arm_rate, double device_force, double asked) {
  const double most = mostForceAt(servo_rate, arm_rate, device_force), held = longestHeld(servo_rate, arm_rate);
  if (most == HUGE_VAL || (asked > 0 && asked <= most)) return "";
  const bool by_arm = arm_rate > 0 && 2 / arm_rate > 1 / servo_rate;
  char text[320], instead[48] = "";
  if (asked > 0) std::snprintf(instead, sizeof instead, " instead of %.3g N", asked);
  std::snprintf(text, sizeof text,
                "%s: after a fault the motors may keep the last command for %.3g ms, so the force "
                "is limited to %.3g N%s, which moves a free arm by at most 1 mm and gives it at most 5 mJ; "
                "expected at least %.0f Hz for the full force",
                by_arm ? "its own rate is low" : "the servo's rate is low", held * 1e3, most, instead,
                std::ceil(by_arm ? kArmRateInFull : kServoRateInFull));
  return text;
}

}  // namespace hapticd::servo
