// SPDX-License-Identifier: MIT
/// Calculates how long [s] a velocity estimate lags behind the hand.
#pragma once
#include <numbers>

#include "description/scene.hpp"

namespace hapticd::servo {

/// [any] Returns the largest delay [s] of an estimator. @param rate [Hz] of the samples
inline double estimatorDelay(const scene::Velocity& how, double rate) {
  if (how.estimator == "butterworth") return 0.5 / rate + 1 / (std::numbers::sqrt2 * std::numbers::pi * how.parameter);
  if (how.estimator == "kalman") return 4 / rate;
  return how.parameter / (2 * rate);
}

}  // namespace hapticd::servo
