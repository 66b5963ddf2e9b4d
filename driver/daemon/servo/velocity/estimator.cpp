// SPDX-License-Identifier: MIT
#include "servo/velocity/estimator.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace hapticd::velocity {
namespace {

[[noreturn]] void refuse(std::string_view name, double parameter, const std::string& expected) {
  char number[32];
  std::snprintf(number, sizeof number, "%g", parameter);
  throw std::invalid_argument("velocity estimator " + std::string(name) + " " + number + ": expected " + expected);
}

int samples(std::string_view name, double parameter, int least, int most) {
  if (!(parameter >= least && parameter <= most) || parameter != std::floor(parameter))
    refuse(name, parameter, "a whole number of samples from " + std::to_string(least) + " to " + std::to_string(most));
  return static_cast<int>(parameter);
}

}  // namespace

VelocityEstimator make(std::string_view name, double parameter, double rate, double resolution) {
  if (!(rate > 0) || !std::isfinite(rate))
    throw std::invalid_argument("velocity estimator: expected a rate above 0 Hz");
  if (!(resolution > 0) || !std::isfinite(resolution))
    throw std::invalid_argument("velocity estimator: expected a resolution above 0 m");
  if (name == "window") return VelocityEstimator(Window(samples(name, parameter, 1, kMaxWindow)));
  if (name == "least_squares") return VelocityEstimator(LeastSquares(samples(name, parameter, 3, kMaxWindow)));
  if (name == "foaw") return VelocityEstimator(AdaptiveWindow(samples(name, parameter, 1, kMaxAdaptive), resolution));
  if (name == "butterworth") {
    if (!(parameter > 0 && parameter < rate / 2)) refuse(name, parameter, "a cut-off between 0 Hz and half the rate");
    return VelocityEstimator(Butterworth(parameter, rate));
  }
  if (name == "kalman") {
    if (!(parameter > 0) || !std::isfinite(parameter)) refuse(name, parameter, "a jerk density above 0 m^2/s^5");
    return VelocityEstimator(Kalman(parameter, resolution));
  }
  refuse(name, parameter, "one of window, butterworth, foaw, least_squares, kalman");
}

Eigen::Vector3d VelocityEstimator::update(const Eigen::Vector3d& position, double dt) noexcept {
  const bool good = position.allFinite() && std::isfinite(dt) && (dt > 0 || !started_);
  if (!good) return velocity_;
  started_ = true;
  velocity_ = std::visit([&](auto& filter) noexcept { return filter.update(position, dt); }, filter_);
  return velocity_;
}

void VelocityEstimator::reset() noexcept {
  std::visit([](auto& filter) noexcept { filter.reset(); }, filter_);
  velocity_.setZero();
  started_ = false;
}

}  // namespace hapticd::velocity
