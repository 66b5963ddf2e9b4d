// SPDX-License-Identifier: MIT
#include "servo/velocity/filters.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace hapticd::velocity {

using Eigen::Vector3d;

Vector3d Window::update(const Vector3d& position, double dt) noexcept {
  history_.push(position, dt);
  const int n = history_.count() - 1;
  double span = 0;
  for (int age = 0; age < n; ++age) span += history_.step(age);
  return span > 0 ? Vector3d((position - history_.position(n)) / span) : Vector3d::Zero();
}

Butterworth::Butterworth(double cutoff_hz, double rate) : period_(1 / rate) {
  const double c = 1 / std::tan(M_PI * cutoff_hz / rate);  // bilinear transform, prewarped so that the cut-off is exact
  b0_ = 1 / (1 + M_SQRT2 * c + c * c);
  a1_ = 2 * (1 - c * c) * b0_;
  a2_ = (1 - M_SQRT2 * c + c * c) * b0_;
}

Vector3d Butterworth::update(const Vector3d& position, double dt) noexcept {
  const double periods = std::round(dt / period_);
  if (!started_ || periods > kMaxMissed) {
    started_ = true;
    primed_ = false;
    last_ = position;
    velocity_.setZero();
    return velocity_;
  }
  const Vector3d difference = (position - last_) / dt;
  last_ = position;
  if (!primed_) {  // starts as if the probe had always moved at this speed, so that the filter does not begin with a
                   // step
    s2_ = (b0_ - a2_) * difference;
    s1_ = (2 * b0_ - a1_) * difference + s2_;
    primed_ = true;
  }
  for (int i = 0; i < std::max(1, static_cast<int>(periods)); ++i) {
    velocity_ = b0_ * difference + s1_;
    s1_ = 2 * b0_ * difference - a1_ * velocity_ + s2_;
    s2_ = b0_ * difference - a2_ * velocity_;
  }
  return velocity_;
}

Vector3d AdaptiveWindow::update(const Vector3d& position, double dt) noexcept {
  history_.push(position, dt);
  Vector3d best = Vector3d::Zero();
  double span = 0;
  for (int n = 1; n < history_.count(); ++n) {
    span += history_.step(n - 1);
    const Vector3d slope = (position - history_.position(n)) / span;
    double back = 0;
    bool fits = true;
    for (int age = 1; age < n && fits; ++age) {
      back += history_.step(age - 1);
      fits = (position - back * slope - history_.position(age)).squaredNorm() <= noise_ * noise_;
    }
    if (!fits) break;
    best = slope;
  }
  return best;
}

Vector3d LeastSquares::update(const Vector3d& position, double dt) noexcept {
  history_.push(position, dt);
  const int n = history_.count();
  double span = 0;
  for (int age = 0; age + 1 < n; ++age) span += history_.step(age);
  if (!(span > 0)) return Vector3d::Zero();
  if (n < 3) return (position - history_.position(n - 1)) / span;
  // Times run from 0 (newest) to -1, and positions are relative to the newest, so the equations are always well scaled.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  double time = 0;
  for (int age = 0; age < n; ++age) {
    const Vector3d powers(1, time, time * time);
    normal += powers * powers.transpose();
    right += powers * (history_.position(age) - position).transpose();
    time -= history_.step(age) / span;
  }
  const Eigen::Matrix3d coefficients = normal.inverse() * right;
  return coefficients.row(1).transpose() / span;
}

Kalman::Kalman(double jerk_density, double resolution)
    : density_(jerk_density), variance_(resolution * resolution / 12) {}

Vector3d Kalman::update(const Vector3d& position, double dt) noexcept {
  if (!started_) {
    started_ = true;
    x_ = position;
    v_.setZero();
    a_.setZero();
    // standard deviations of the motion of a hand: 1 m/s, 10 m/s^2
    covariance_ = Vector3d(variance_, 1, 100).asDiagonal();
    return v_;
  }
  const double t2 = dt * dt / 2;
  x_ += dt * v_ + t2 * a_;
  v_ += dt * a_;
  Eigen::Matrix3d transition, noise;
  transition << 1, dt, t2, 0, 1, dt, 0, 0, 1;
  const double d2 = dt * dt, d3 = d2 * dt;
  noise << d3 * d2 / 20, d2 * d2 / 8, d3 / 6, d2 * d2 / 8, d3 / 3, d2 / 2, d3 / 6, d2 / 2, dt;
  const Eigen::Matrix3d predicted = transition * covariance_ * transition.transpose() + density_ * noise;
  const Vector3d gain = predicted.col(0) / (predicted(0, 0) + variance_);
  const Vector3d innovation = position - x_;
  x_ += gain[0] * innovation;
  v_ += gain[1] * innovation;
  a_ += gain[2] * innovation;
  covariance_ = predicted - gain * predicted.row(0);
  covariance_ = ((covariance_ + covariance_.transpose()) / 2).eval();  // symmetric, also after days of rounding errors
  return v_;
}

}  // namespace hapticd::velocity
