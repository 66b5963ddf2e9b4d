// SPDX-License-Identifier: MIT
/// Checks the claims of the NURBS paper about its velocity estimate.
#include <gtest/gtest.h>

#include <cmath>

#include "delays.hpp"
#include "response.hpp"
#include "servo/velocity/estimator.hpp"

namespace hapticd::velocity_bench {
namespace {

constexpr double kRate = 1500;

TEST(PaperClaims, TheWindowIsNotDelayFree) {
  const WindowResponse window = windowResponse(15, kRate, 10);
  EXPECT_NEAR(window.delay, 5e-3, 1e-15);
  EXPECT_NEAR(windowCutoff(15, kRate), 44.3, 0.05);
  EXPECT_NEAR(window.noise_gain, M_SQRT2 / 0.01, 1e-9);
}

TEST(PaperClaims, TheProductionWindowIsLateByHalfItsLength) {
  auto estimator = velocity::make("window", 15, kRate);
  double v = 0;  // for x = t^2 the window gives exactly 2 (t - n T/2)
  for (int i = 0; i <= 60; ++i) v = estimator.update({std::pow(i / kRate, 2), 0, 0}, i == 0 ? 0 : 1 / kRate).x();
  EXPECT_NEAR(60 / kRate - v / 2, 5e-3, 1e-12);
}

TEST(PaperClaims, LowPassesHaveThreeTimesTheDelayOnlyFromHighOrdersOn) {
  const double cutoff = windowCutoff(15, kRate), window = 5e-3;
  const double butterworth[][2] = {{2, 1.08}, {4, 1.94}, {6, 2.83}, {7, 3.29}};
  for (const auto& [order, ratio] : butterworth)
    EXPECT_NEAR(butterworthDelay(static_cast<int>(order), cutoff, kRate) / window / ratio, 1, 0.01) << order;
  const double chebyshev[][2] = {{2, 1.00}, {4, 2.14}, {5, 3.57}};
  for (const auto& [order, ratio] : chebyshev)
    EXPECT_NEAR(chebyshevDelay(static_cast<int>(order), 1, cutoff, kRate) / window / ratio, 1, 0.01) << order;
}

TEST(PaperClaims, TheIdealDifferentiatorCutShortNeedsItsGainBack) {
  const double gains[][2] = {{2, 1.273}, {4, 0.849}, {8, 0.922}, {16, 0.960}, {32, 0.980}};
  for (const auto& [taps, gain] : gains) EXPECT_NEAR(truncatedGain(static_cast<int>(taps)), gain, 6e-4) << taps;
  EXPECT_NEAR(truncatedNoise(32, kRate) / 2720, 1, 0.03);
  EXPECT_NEAR(windowResponse(1, kRate, 10).noise_gain, 2121, 1);
}

}  // namespace
}  // namespace hapticd::velocity_bench
