// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "servo/velocity/estimator.hpp"

namespace hapticd {
namespace {

using Eigen::Vector3d;

struct Kind {
  const char* name;
  double parameter;
};
constexpr Kind kKinds[] = {{"window", 15}, {"butterworth", 120}, {"foaw", 15}, {"least_squares", 15}, {"kalman", 1e3}};

TEST(VelocityEstimator, FindsAConstantVelocityThroughMissedTicks) {
  const Vector3d truth(0.3, -0.1, 0.2);
  for (const Kind& kind : kKinds) {
    auto estimator = velocity::make(kind.name, kind.parameter, 1000);
    Vector3d got;
    double t = 0;
    for (int i = 0; i < 2000; ++i) {
      const double dt = i == 0 ? 0 : i % 7 == 0 ? 3e-3 : 1e-3;
      t += dt;
      got = estimator.update(t * truth, dt);
    }
    EXPECT_LT((got - truth).norm(), 1e-6) << kind.name;
  }
}

TEST(VelocityEstimator, SurvivesNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Kind& kind : kKinds) {
    auto estimator = velocity::make(kind.name, kind.parameter, 1000);
    for (int i = 0; i < 100; ++i)
      EXPECT_TRUE(
          estimator.update(i % 5 == 2 ? Vector3d(nan, 0, 0) : Vector3d(1e-4 * i, 0, 0), i ? 1e-3 : 0).allFinite());
  }
}

TEST(VelocityEstimator, RefusesWhatItCannotBe) {
  EXPECT_THROW(velocity::make("window", 2.5, 1000), std::invalid_argument);
  EXPECT_THROW(velocity::make("butterworth", 600, 1000), std::invalid_argument);
  EXPECT_THROW(velocity::make("wavelet", 3, 1000), std::invalid_argument);
}

}  // namespace
}  // namespace hapticd
