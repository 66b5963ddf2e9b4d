// SPDX-License-Identifier: MIT
/// Bodies that the probe is certainly outside of. They need not be searched again while it stays near.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hapticd::brep {

/// Each body is known with a ball that its surface does not reach: whoever is outside of the body at the centre of the
/// ball is outside everywhere in it.
class OutsideBodies {
 public:
  /// [main] @param places number of placements of the model
  explicit OutsideBodies(std::size_t places) : balls_(places) {}

  /// [rt] Forgets everything.
  void reset() noexcept { ++age_; }
  /// [rt] Records that p is outside of a body. @param distance [m] lower bound of the distance from p to its surface
  void keep(std::uint32_t place, const Eigen::Vector3d& p, double distance) noexcept {
    balls_[place] = {p, distance, age_};
  }
  /// [rt] True if p is certainly outside of a body.
  bool isOutside(std::uint32_t place, const Eigen::Vector3d& p) const noexcept {
    constexpr double kRoundedDown = 1 - 1e-9;
    const Ball& ball = balls_[place];
    return ball.age == age_ && (p - ball.center).norm() < ball.radius * kRoundedDown;
  }

 private:
  struct Ball {
    Eigen::Vector3d center{0, 0, 0};
    double radius = 0;      // [m]
    std::uint64_t age = 0;  // age_ when it was kept; a ball of another age is forgotten
  };
  std::vector<Ball> balls_;  // one for each placement
  std::uint64_t age_ = 1;
};

}  // namespace hapticd::brep
