// SPDX-License-Identifier: MIT
/// Bodies that the probe is certainly outside of. They need not be searched again while it stays near.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/brep/model/model.hpp"

namespace hapticd::brep {

/// Each body is known with a ball that its surface does not reach: whoever is outside of the body at the centre of the
/// ball is outside everywhere in it.
class OutsideBodies {
 public:
  static constexpr std::size_t kMost = 8;

  /// [rt] Forgets everything.
  void reset() noexcept { *this = {}; }
  /// [rt] Records that p is outside of a body. @param distance [m] lower bound of the distance from p to its surface
  void keep(std::uint32_t place, const Eigen::Vector3d& p, double distance) noexcept {
    for (Ball& ball : balls_)
      if (ball.place == place) {
        ball = {place, p, distance};
        return;
      }
    balls_[oldest_] = {place, p, distance};
    oldest_ = (oldest_ + 1) % kMost;
  }
  /// [rt] True if p is certainly outside of a body.
  bool isOutside(std::uint32_t place, const Eigen::Vector3d& p) const noexcept {
    constexpr double kRoundedDown = 1 - 1e-9;
    for (const Ball& ball : balls_)
      if (ball.place == place) return (p - ball.center).norm() < ball.radius * kRoundedDown;
    return false;
  }

 private:
  struct Ball {
    std::uint32_t place = kNone;
    Eigen::Vector3d center{0, 0, 0};
    double radius = 0;  // [m]
  };
  std::array<Ball, kMost> balls_;
  std::size_t oldest_ = 0;
};

}  // namespace hapticd::brep
