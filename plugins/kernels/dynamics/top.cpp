// SPDX-License-Identifier: MIT
#include "kernels/dynamics/top.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/dynamics/splitting.hpp"

namespace hapticd::dynamics {
namespace {

using Eigen::Vector3d;

/// sin and 1 - cos of half an angle. The angles of a step are small, so the series are fast and exact to rounding.
struct HalfAngle {
  double sine, versine;
};
HalfAngle half(double angle) noexcept {
  const double x = angle / 2, s = x * x;
  if (s > 0.01) {
    const double quarter = std::sin(x / 2);
    return {std::sin(x), 2 * quarter * quarter};
  }
  return {x * (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110))))),
          s / 2 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90 * (1 - s / 132)))))};
}

/// Continues `turn` by a turn of `angle` about a body axis, and changes `momentum` to its components in the axes of the
/// turned body.
void about(int axis, double angle, SmallTurn& turn, Vector3d& momentum) noexcept {
  const HalfAngle h = half(angle);
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  const Vector3d v = turn.vector;
  const double w = 1 + turn.less;
  turn.vector[axis] = v[axis] + (w * h.sine - h.versine * v[axis]);
  turn.vector[j] = v[j] + (h.sine * v[k] - h.versine * v[j]);
  turn.vector[k] = v[k] - (h.sine * v[j] + h.versine * v[k]);
  turn.less -= h.versine * w + h.sine * v[axis];
  // sin and 1 - cos of the whole angle
  const double sine = 2 * h.sine * (1 - h.versine), versine = 2 * h.sine * h.sine;
  const double mj = momentum[j], mk = momentum[k];
  momentum[j] = mj + (sine * mk - versine * mj);
  momentum[k] = mk - (sine * mj + versine * mk);
}

}  // namespace

Top::Top(const Vector3d& principal) noexcept {
  const Vector3d inverse = principal.cwiseInverse();
  double least = -1;
  for (int r = 0; r < 3; ++r) {
    const int a = (r + 1) % 3, b = (r + 2) % 3;
    const double disturbance = std::abs((inverse[a] - inverse[r]) * (inverse[b] - inverse[r]));
    if (least >= 0 && disturbance >= least) continue;
    least = disturbance;
    a_ = a, b_ = b;
    world_rate_ = inverse[r];
    rate_a_ = inverse[a] - inverse[r];
    rate_b_ = inverse[b] - inverse[r];
  }
  fastest_ = std::max(std::abs(rate_a_), std::abs(rate_b_));
}

SmallTurn Top::bodyTurn(Vector3d momentum, double h) const noexcept {
  SmallTurn turn;
  const auto part_a = [&](double time) { about(a_, time * rate_a_ * momentum[a_], turn, momentum); };
  const auto part_b = [&](double time) { about(b_, time * rate_b_ * momentum[b_], turn, momentum); };
  if (rate_a_ == 0 && rate_b_ == 0) return turn;
  if (symmetric()) {
    rate_a_ == 0 ? part_b(h) : part_a(h);
  } else {
    Splitting::step(h, part_a, part_b);
  }
  return turn;
}

SmallTurn Top::roughBodyTurn(Vector3d momentum, double h) const noexcept {
  SmallTurn turn;
  about(a_, h / 2 * rate_a_ * momentum[a_], turn, momentum);
  about(b_, h * rate_b_ * momentum[b_], turn, momentum);
  about(a_, h / 2 * rate_a_ * momentum[a_], turn, momentum);
  return turn;
}

}  // namespace hapticd::dynamics
