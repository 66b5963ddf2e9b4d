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
  const int quarter = 200 * (n + 4);
  for (int i = 0; i < 4 * quarter; ++i) {
    double& oldest = past[static_cast<size_t>(i % n)];
    const double force = -k * x - b * (x - oldest) / n;
    oldest = x;
    x += v + force / 2;
    v += force;
    double& largest = swing[static_cast<size_t>(i / quarter)];
    largest = std::max(largest, std::abs(x) + std::abs(v));
    if (!(largest < 1e9)) return false;
  }
  return swing[3] < swing[1];
}

/// Finds the largest stable k for a damping b by bisection: below it every k is stable, and above it none is.
double largestStiffness(double b, int n) noexcept {
  constexpr int kHalvings = 18;
  double low = 0, high = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (comesToRest(middle, b, n) ? low : high) = middle;
  }
  return low;
}

}  // namespace

bool stableAlone(double mass, double stiffness, double damping, int n, double period) noexcept {
  return comesToRest(stiffness * period * period / mass, damping * period / mass, std::clamp(n, 1, kLongestWindow));
}

double maxStiffnessAlone(double mass, int n, double period) noexcept {
  const int window = std::clamp(n, 1, kLongestWindow);
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 22;
  double low = 0, high = 1.5 / std::sqrt(window);
  for (int i = 0; i < kSteps; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (largestStiffness(a, window) > largestStiffness(b, window)) {
      high = b;
    } else {
      low = a;
    }
  }
  return largestStiffness((low + high) / 2, window) * mass / (period * period);
}

}  // namespace hapticd::passivity
