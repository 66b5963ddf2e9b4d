// SPDX-License-Identifier: MIT
/// A claim that has seen a probe at rest.
#pragma once
#include <gtest/gtest.h>

#include "servo/safety/claim.hpp"

namespace hapticd::servo {

constexpr double kTick = 1e-3;

inline ClaimStep at(const Eigen::Vector3d& p, const Eigen::Vector3d& force) {
  ClaimStep step;
  step.p_world = step.p_model = p;
  step.force = force;
  return step;
}

/// The probe rests at the origin, with a force of its own.
struct Rested {
  explicit Rested(const Eigen::Vector3d& force = Eigen::Vector3d::Zero(), ClaimBounds given = {}) : bounds(given) {
    claim.check(at(Eigen::Vector3d::Zero(), force), bounds, 0, held);
    EXPECT_FALSE(held) << "the first is compared with nothing";
  }
  Eigen::Vector3d next(const ClaimStep& step, double dt = kTick) { return claim.check(step, bounds, dt, held); }
  ClaimBounds bounds;
  Claim claim;
  bool held = false;
};

}  // namespace hapticd::servo
