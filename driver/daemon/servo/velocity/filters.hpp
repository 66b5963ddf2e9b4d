// SPDX-License-Identifier: MIT
/// The velocity estimators, each with one parameter. All of them accept a dt that varies, because a missed tick doubles
/// the time between two samples.
#pragma once
#include <Eigen/Core>

#include "servo/velocity/history.hpp"

namespace hapticd::velocity {

constexpr int kMaxWindow = 1024;  ///< most samples of a window
constexpr int kMaxAdaptive = 32;  ///< most samples of foaw; its cost grows with the square of their number
/// a filter continues after a gap of at most this many periods; after a longer gap it restarts
constexpr int kMaxMissed = 16;

/// The difference (x_i - x_(i-n)) / (nT) of Thompson et al. 1999, Eq. 5. Its delay is nT/2, its gain for white noise
/// sqrt(2)/(nT).
class Window {
 public:
  explicit Window(int n) : history_(n + 1) {}                                   ///< [main]
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;  ///< [rt]
  void reset() noexcept { history_.clear(); }                                   ///< [rt]

 private:
  History history_;
};

/// The difference of two samples, filtered by a second-order Butterworth low-pass filter.
class Butterworth {
 public:
  Butterworth(double cutoff_hz, double rate);                                   ///< [main]
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;  ///< [rt]
  void reset() noexcept { started_ = false; }                                   ///< [rt]

 private:
  double period_, b0_, a1_, a2_;  // transposed direct form II with b = b0 (1, 2, 1)
  Eigen::Vector3d last_{0, 0, 0}, s1_{0, 0, 0}, s2_{0, 0, 0}, velocity_{0, 0, 0};
  bool started_ = false, primed_ = false;
};

/// First-order adaptive window (Janabi-Sharifi, Hayward, Chen 2000): uses the longest window for which a straight line
/// between its end points meets every sample within the noise. The window is long at rest, for low noise, and short in
/// motion, for a short delay.
class AdaptiveWindow {
 public:
  AdaptiveWindow(int longest, double noise) : history_(longest + 1), noise_(noise) {}  ///< [main] noise [m]
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;         ///< [rt]
  void reset() noexcept { history_.clear(); }                                          ///< [rt]

 private:
  History history_;
  double noise_;
};

/// Fits a parabola to the last n samples by least squares, and takes its slope at the newest sample.
class LeastSquares {
 public:
  explicit LeastSquares(int n) : history_(n) {}                                 ///< [main] n >= 3
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;  ///< [rt]
  void reset() noexcept { history_.clear(); }                                   ///< [rt]

 private:
  History history_;
};

/// Kalman filter with a constant-acceleration model, driven by white-noise jerk.
class Kalman {
 public:
  /// [main] @param jerk_density spectral density of the jerk [m^2/s^5]  @param resolution of the measured positions [m]
  Kalman(double jerk_density, double resolution);
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;  ///< [rt]
  void reset() noexcept { started_ = false; }                                   ///< [rt]

 private:
  double density_, variance_;
  Eigen::Vector3d x_{0, 0, 0}, v_{0, 0, 0}, a_{0, 0, 0};
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  // the same for every axis
  bool started_ = false;
};

}  // namespace hapticd::velocity
