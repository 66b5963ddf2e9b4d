// SPDX-License-Identifier: MIT
#include "servo/safety/passivity/isolated.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hapticd::passivity {
namespace {

constexpr int kLongestWindow = 256;

/// True if the motion decays: in a long simulation, the largest swing of the last quarter is smaller than that of the
/// second quarter. The parameters have no units: k = K T^2 / m, b = B T / m.
bool comesToRest(double k, double b, int n) noexcept {
  std::array<double, kLongestWindow> past;  // positions of the last n samples
  past.fill(1);
  double x = 1, v = 0;
  std::array<double, 4> swing{};
  int oldest_at = 0;
  for (double& largest : swing) {
    for (int i = 0; i < 200 * (n + 4); ++i) {
      double& oldest = past[static_cast<size_t>(oldest_at)];
      oldest_at = oldest_at + 1 < n ? oldest_at + 1 : 0;
      const double force = -k * x - b * (x - oldest) / n;
      oldest = x;
      x += v + force / 2;
      v += force;
      largest = std::max(largest, std::abs(x) + std::abs(v));
      if (!(largest < 1e9)) return false;
    }
  }
  return swing[3] < swing[1];
}

/// Finds the largest stable k for a damping b by bisection: below it every k is stable, and above it none is. Whatever
/// b is, k n^(3/2) stays below 1.3.
double largestStiffness(double b, int n) noexcept {
  constexpr int kHalvings = 12;  // to 0.1 % of the largest k, which is enough for a warning
  double low = 0, high = 1.5 / (n * std::sqrt(n));
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (comesToRest(middle, b, n) ? low : high) = middle;
  }
  return low;
}

}  // namespace

double maxStiffnessAlone(double mass, int n, double period) noexcept {
  const int window = std::clamp(n, 1, kLongestWindow);
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 14;
  double low = 0, high = 1.5 / std::sqrt(window);
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double stiffness_left = largestStiffness(left, window), stiffness_right = largestStiffness(right, window);
  for (int i = 0; i < kSteps; ++i) {          // golden-section search: each step simulates one new damping
    if (stiffness_left >= stiffness_right) {  // both are 0 where the damping alone is unstable
      high = right, right = left, stiffness_right = stiffness_left;
      stiffness_left = largestStiffness(left = high - kGolden * (high - low), window);
    } else {
      low = left, left = right, stiffness_left = stiffness_right;
      stiffness_right = largestStiffness(right = low + kGolden * (high - low), window);
    }
  }
  return largestStiffness((low + high) / 2, window) * mass / (period * period);
}

double maxDampingAlone(double mass, int n, double period) noexcept {
  constexpr double kSoft = 1e-4;  // so soft that the damping alone matters, and so stiff that the motion decays
  constexpr int kHalvings = 12;
  double low = 0, high = 3;  // whatever n is, b stays below 2.1
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (comesToRest(kSoft, middle, std::clamp(n, 1, kLongestWindow)) ? low : high) = middle;
  }
  return low * mass / period;
}

}  // namespace hapticd::passivity
