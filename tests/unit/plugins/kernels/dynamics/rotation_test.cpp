// SPDX-License-Identifier: MIT
#include "kernels/dynamics/rotation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/sweep.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// a * n / 2 less whole turns, in [rad]: a is the length of `turn` to 1e-31, so that 1e8 of them are known to 1e-19.
double halfAngleAfter(const Vector3d& turn, int64_t n) {
  using Long = long double;
  Long square = 0, rest = 0;  // of the length, as a sum of two
  for (int i = 0; i < 3; ++i) {
    const double product = turn[i] * turn[i];
    square += product;
    rest += std::fma(turn[i], turn[i], -product);
  }
  Long length = std::sqrt(square + rest);
  length += (std::fma(-length, length, square) + rest) / (2 * length);
  constexpr Long kTwoPi = 6.283185307179586476925286766559005768L;
  const Long half = length / 2 * static_cast<Long>(n);
  return static_cast<double>(half - kTwoPi * std::floor(half / kTwoPi));
}

double errorAfter(const Rotation& rotation, const Vector3d& turn, int64_t n) {
  const double half = halfAngleAfter(turn, n);
  Quaterniond truth(std::cos(half), 0, 0, 0);
  truth.vec() = std::sin(half) * turn.normalized();
  const double plus = (rotation.quaternion().coeffs() - truth.coeffs()).norm();
  return 2 * std::min(plus, (rotation.quaternion().coeffs() + truth.coeffs()).norm());
}

TEST(Rotation, ManyTicksDriftByRoundingOnly) {
  const Vector3d turn(1e-3, -2e-3, 2e-3);                          // 3 rad/s at 1 kHz
  const int64_t ticks = support::kLong ? 100'000'000 : 3'000'000;  // 28 hours
  Rotation rotation;
  for (int64_t i = 0; i < ticks; ++i) rotation.turnWorld(turn);
  const double error = errorAfter(rotation, turn, ticks);
  RecordProperty("error_rad", std::to_string(error));
  EXPECT_LT(error, 1e-19 * static_cast<double>(ticks));
  EXPECT_LT((rotation.matrix().transpose() * rotation.matrix() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(Rotation, AMillionTicksStayWithinAHundredthOfThatForAnyTurnUpToATenth) {
  constexpr int kTicks = 1'000'000;
  for (const Vector3d& turn :
       {Vector3d(1e-9, 0, 0), Vector3d(0, 3e-5, -2e-5), Vector3d(0, 0, 2 * M_PI / 1000), Vector3d(0.05, -0.05, 0.07)}) {
    Rotation world, body;
    for (int i = 0; i < kTicks; ++i) {
      world.turnWorld(turn);
      body.turnBody(turn);
    }
    EXPECT_LT(errorAfter(world, turn, kTicks), 1e-13) << turn.norm();
    EXPECT_LT(errorAfter(body, turn, kTicks), 1e-13) << turn.norm();
  }
}

TEST(Rotation, TurnsAboutTheBodyAndAboutTheWorldAreTheTwoProducts) {
  const Quaterniond start(Eigen::AngleAxisd(0.8, Vector3d(1, 2, -1).normalized()));
  for (const double angle : {1e-8, 1e-3, 0.5, 0.999, 1.001, 3.0, 100.0}) {
    const Vector3d turn = angle * Vector3d(2, -1, 2) / 3;
    const Quaterniond by(Eigen::AngleAxisd(angle, turn.normalized()));
    Rotation world(start), body(start);
    world.turnWorld(turn);
    body.turnBody(turn);
    EXPECT_LT(world.quaternion().angularDistance(by * start), 1e-15 * (4 + angle)) << angle;
    EXPECT_LT(body.quaternion().angularDistance(start * by), 1e-15 * (4 + angle)) << angle;
    EXPECT_LT(rotationBy(turn).angularDistance(by), 1e-15 * (4 + angle)) << angle;
  }
}

TEST(Rotation, NotANumberLeavesAUnitQuaternion) {
  Rotation rotation(Quaterniond(0.6, 0.8, 0, 0));
  rotation.turnWorld({NAN, 0, 0});
  EXPECT_NEAR(rotation.quaternion().norm(), 1, 1e-15);
}

}  // namespace
}  // namespace hapticd::dynamics
