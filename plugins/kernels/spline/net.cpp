// SPDX-License-Identifier: MIT
#include "kernels/spline/net.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::spline {
namespace {

/// If the binary exponent of the largest coordinate is outside these limits, all coordinates are scaled so that the
/// largest is about 1. Then no sum overflows and no product becomes subnormal. Within these limits nothing is
/// scaled, which saves time.
constexpr int kLargestExponent = 200;
constexpr int kSmallestExponent = -200;

/// Largest ratio of two weights of kMild. Beyond it the points with smaller weights would lose more than two digits.
constexpr double kMildRatio = 100;

Weights kindOf(const std::vector<double>& weights) {
  if (weights.empty()) return Weights::kNone;
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  if (*least == *most) return Weights::kNone;
  return *most / kMildRatio <= *least ? Weights::kMild : Weights::kSevere;
}

double scaleOf(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0;
  for (const auto& point : points) largest = std::max(largest, point.cwiseAbs().maxCoeff());
  if (largest == 0) return 1;
  const int exponent = std::ilogb(largest);
  return exponent > kLargestExponent || exponent < kSmallestExponent ? std::ldexp(1.0, exponent) : 1;
}

/// Returns the binary exponent half-way between those of the smallest and the largest weight.
int middleExponent(const std::vector<double>& weights) {
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  return (std::ilogb(*least) + std::ilogb(*most)) / 2;
}

}  // namespace

Net makeNet(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights) {
  Net net;
  net.scale = scaleOf(points);
  net.weights = kindOf(weights);
  const int middle = net.rational() ? middleExponent(weights) : 0;
  net.points.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d point = points[i] / net.scale;
    net.points.push_back({point.x(), point.y(), point.z(), net.rational() ? std::ldexp(weights[i], -middle) : 0});
  }
  return net;
}

}  // namespace hapticd::spline
