// SPDX-License-Identifier: MIT
#include "servo/safety/passivity/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::passivity {
namespace {

double dirichlet(int n, double theta) noexcept {
  return std::sin((n + 0.5) * theta) / std::sin(theta / 2);
}

/// Range of passive stiffnesses. The condition at one frequency is an upper bound, or a lower bound at frequencies
/// where the delay changes the sign of the stiffness.
struct Interval {
  double low = 0, high = std::numeric_limits<double>::infinity();
};

struct Wall {
  double b, damping;
  int n, delay;
  double period;

  /// Returns, at one frequency, the part of the damping b [N s/m] that the wall's damping leaves for its stiffness.
  double left(double theta) const noexcept {
    return b - damping / (2 * n) * (dirichlet(delay, theta) - dirichlet(delay + n, theta));
  }
  /// Returns, at one frequency, how much of this damping each N/m of stiffness needs [s].
  double share(double theta) const noexcept { return period / 2 * dirichlet(delay, theta); }
  double bound(double theta) const noexcept { return left(theta) / share(theta); }
};

/// Finds the minimum of sign * bound between two grid points by golden-section search.
double refine(const Wall& wall, double sign, double low, double high) noexcept {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (sign * wall.bound(a) < sign * wall.bound(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return wall.bound((low + high) / 2);
}

}  // namespace

WindowCoefficient windowCoefficient(int n) noexcept {
  const double a = n + 0.5;
  double low = M_PI / a, high = 2 * M_PI / a;  // the first lobe below zero is the deepest
  constexpr int kHalvings = 80;
  for (int i = 0; i < kHalvings; ++i) {
    const double t = (low + high) / 2;
    const double slope = a * std::cos(a * t) * std::sin(t / 2) - 0.5 * std::sin(a * t) * std::cos(t / 2);
    (slope < 0 ? low : high) = t;
  }
  const double theta = std::min((low + high) / 2, M_PI);
  return {(1 - dirichlet(n, theta)) / (2 * n), theta};
}

double maxStiffness(double b, double damping, int n, int delay, double period) noexcept {
  const Wall wall{b, damping, n, delay, period};
  const int points = 512 * (delay + n + 1);
  const double step = M_PI / points;
  Interval k;
  for (int i = 1; i <= points; ++i) {
    const double theta = i == points ? M_PI : (i - 0.5) * step;
    const double share = wall.share(theta);
    const double floor = 1e-9 * period * (delay + 1);
    if (share > floor) k.high = std::min(k.high, wall.bound(theta));
    if (share < -floor) k.low = std::max(k.low, wall.bound(theta));
    if (i == 1 || i >= points - 1 || std::fabs(share) <= floor) continue;
    const double before = wall.bound(theta - step), here = wall.bound(theta), after = wall.bound(theta + step);
    const bool same_side = wall.share(theta - step) * share > 0 && wall.share(theta + step) * share > 0;
    const double sign = share > 0 ? 1 : -1;
    if (!same_side || sign * here > sign * before || sign * here > sign * after) continue;
    const double best = refine(wall, sign, theta - step, theta + step);
    if (share > 0) {
      k.high = std::min(k.high, best);
    } else {
      k.low = std::max(k.low, best);
    }
  }
  // the limit theta -> 0, for which D_n -> 2n + 1
  k.high = std::min(k.high, (b + damping) / (period * (delay + 0.5)));
  return k.high > k.low ? k.high : 0;
}

double maxStiffnessQuantised(double b, double friction, double resolution, double period) noexcept {
  const double by_friction = resolution > 0 ? 2 * friction / resolution : std::numeric_limits<double>::infinity();
  return std::min(2 * b / period, by_friction);
}

}  // namespace hapticd::passivity
