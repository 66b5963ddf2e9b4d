// SPDX-License-Identifier: MIT
/// The estimators, each with one knob. All take samples at varying dt: a missed tick gives a multiple of the period.
#pragma once
#include <Eigen/Core>

#include "servo/velocity/history.hpp"

namespace hapticd::velocity {

constexpr int kMaxWindow = 1024;  ///< samples of a window
constexpr int kMaxAdaptive = 32;  ///< most samples of foaw, whose cost grows with the square of their number
constexpr int kMaxMissed = 16;    ///< periods that a filter bridges; after a longer gap it restarts

/// (x_i - x_(i-n)) / (nT): Thompson et al. 1999, Eq. 5. Delay nT/2, white-noise gain sqrt(2)/(nT).
class Window {
 public:
  explicit Window(int n) : history_(n + 1) {}                                   ///< [main]
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;  ///< [rt]
  void reset() noexcept { history_.clear(); }                                   ///< [rt]

 private:
  History history_;
};

/// The difference of two samples through a low pass of second order, Butterworth.
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

/// First-order adaptive window (Janabi-Sharifi, Hayward, Chen 2000): the longest window whose end points predict every
/// sample between them within the noise. Long and quiet at rest, short and fast in motion.
class AdaptiveWindow {
 public:
  AdaptiveWindow(int longest, double noise) : history_(longest + 1), noise_(noise) {}  ///< [main] noise [m]
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;         ///< [rt]
  void reset() noexcept { history_.clear(); }                                          ///< [rt]

 private:
  History history_;
  double noise_;
};

/// Slope at the newest sample of the parabola through the last n samples with least squares.
class LeastSquares {
 public:
  explicit LeastSquares(int n) : history_(n) {}                                 ///< [main] n >= 3
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;  ///< [rt]
  void reset() noexcept { history_.clear(); }                                   ///< [rt]

 private:
  History history_;
};

/// Kalman filter of constant acceleration, driven by white jerk.
class Kalman {
 public:
  /// [main] @param jerk_density of the white jerk [m^2/s^5]  @param resolution step of the measured positions [m]
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
