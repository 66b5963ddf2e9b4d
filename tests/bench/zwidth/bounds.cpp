// SPDX-License-Identifier: MIT
#include "bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::zwidth {
namespace {

double dirichlet(int n, double theta) noexcept {
  return std::sin((n + 0.5) * theta) / std::sin(theta / 2);
}

/// Range of passive stiffnesses. The condition at one frequency is an upper bound, or a lower bound at frequencies
/// where the delay changes the sign of the stiffness.
struct Interval {
  double low = 0, high = std::numeric_limits<double>::infinity();
};

/// The condition of passivity of a wall on a device of damping b [N s/m].
struct Condition {
  const Wall& wall;
  double b;

  /// Returns, at one frequency, the part of the damping b [N s/m] that the wall's damping leaves for its stiffness.
  double left(double theta) const noexcept {
    const double change = dirichlet(wall.delay, theta) - dirichlet(wall.delay + wall.window, theta);
    return b - wall.damping / (2 * wall.window) * change;
  }
  /// Returns, at one frequency, how much of this damping each N/m of stiffness needs [s].
  double share(double theta) const noexcept { return wall.period / 2 * dirichlet(wall.delay, theta); }
  double bound(double theta) const noexcept { return left(theta) / share(theta); }
};

/// Finds the minimum of sign * bound between two grid points by golden-section search.
double refine(const Condition& at, double sign, double low, double high) noexcept {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (sign * at.bound(a) < sign * at.bound(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return at.bound((low + high) / 2);
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

double maxStiffness(const Wall& wall, const Body& device) noexcept {
  const Condition at{wall, device.damping};
  const int points = 512 * (wall.delay + wall.window + 1);
  const double step = M_PI / points;
  Interval k;
  for (int i = 1; i <= points; ++i) {
    const double theta = i == points ? M_PI : (i - 0.5) * step;
    const double share = at.share(theta);
    const double floor = 1e-9 * wall.period * (wall.delay + 1);
    if (share > floor) k.high = std::min(k.high, at.bound(theta));
    if (share < -floor) k.low = std::max(k.low, at.bound(theta));
    if (i == 1 || i >= points - 1 || std::fabs(share) <= floor) continue;
    const double before = at.bound(theta - step), here = at.bound(theta), after = at.bound(theta + step);
    const bool same_side = at.share(theta - step) * share > 0 && at.share(theta + step) * share > 0;
    const double sign = share > 0 ? 1 : -1;
    if (!same_side || sign * here > sign * before || sign * here > sign * after) continue;
    const double best = refine(at, sign, theta - step, theta + step);
    if (share > 0) {
      k.high = std::min(k.high, best);
    } else {
      k.low = std::max(k.low, best);
    }
  }
  // the limit theta -> 0, for which D_n -> 2n + 1
  k.high = std::min(k.high, (device.damping + wall.damping) / (wall.period * (wall.delay + 0.5)));
  return k.high > k.low ? k.high : 0;
}

double maxStiffnessQuantised(const Wall& wall, const Body& device) noexcept {
  const double by_friction =
      wall.resolution > 0 ? 2 * device.friction / wall.resolution : std::numeric_limits<double>::infinity();
  return std::min(2 * device.damping / wall.period, by_friction);
}

}  // namespace hapticd::zwidth
