// SPDX-License-Identifier: MIT
#include "kernels/dynamics/rotation.hpp"

#include <cmath>

namespace hapticd::dynamics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

/// A turn by the angle a as the quaternion (1 + cosine_less_one, turn/2 - turn * shortfall), with sin(a/2)/a = 1/2 -
/// shortfall. turn/2 is exact, and the small corrections are stored separately. So a turn that is repeated 1e8 times
/// still has the right length.
struct HalfTurn {
  double shortfall, cosine_less_one;
};

/// The squared length of a vector as a sum of two numbers, with a relative error of 1e-31.
struct Square {
  double high, low;
};
Square squareOf(const Vector3d& a) noexcept {
  Square sum{0, 0};
  for (int i = 0; i < 3; ++i) {
    const double product = a[i] * a[i];
    const double total = sum.high + product;
    const double part = total - sum.high;
    sum.low += std::fma(a[i], a[i], -product) + (sum.high - (total - part)) + (product - part);
    sum.high = total;
  }
  return sum;
}

HalfTurn halfTurn(const Vector3d& turn) noexcept {
  const Square square = squareOf(turn);
  const double s = square.high;
  if (s > 1) {
    const double angle = std::sqrt(s), quarter = std::sin(angle / 4);
    return {0.5 - std::sin(angle / 2) / angle, -2 * quarter * quarter};
  }
  // 1/2 - sin(a/2)/a = s/48 (1 - s/80 (1 - s/168 (1 - ...))) with s = a^2; the numbers continue as 4 (2k) (2k+1)
  const double tail = 1 - s / 80 * (1 - s / 168 * (1 - s / 288 * (1 - s / 440 * (1 - s / 624 * (1 - s / 840)))));
  const double cosine = 1 - s / 48 * (1 - s / 120 * (1 - s / 224 * (1 - s / 360 * (1 - s / 528 * (1 - s / 728)))));
  return {(s * tail + square.low) / 48, -s / 8 * cosine};
}

/// Returns a1 b1 + a2 b2 + a3 b3, and adds the rounding error of this sum to `rest`.
double exactDot(const Vector3d& a, const Vector3d& b, double& rest) noexcept {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double product = a[i] * b[i];
    const double total = sum + product;
    const double part = total - sum;
    rest += std::fma(a[i], b[i], -product) + (sum - (total - part)) + (product - part);
    sum = total;
  }
  return sum;
}

/// Returns |q + carry|^2 - 1, with the sum taken exactly.
double excessLength(const Vector4d& q, const Vector4d& carry) noexcept {
  double excess = -1, low = 0;
  for (int i = 0; i < 4; ++i) {
    const double square = q[i] * q[i];
    low += std::fma(q[i], q[i], -square) + 2 * q[i] * carry[i];
    const double sum = excess + square;
    const double part = sum - excess;
    low += (excess - (sum - part)) + (square - part);
    excess = sum;
  }
  return excess + low;
}

}  // namespace

Quaterniond rotationBy(const Vector3d& turn) noexcept {
  const HalfTurn half = halfTurn(turn);
  const Vector3d v = turn / 2 - half.shortfall * turn;
  return {1 + half.cosine_less_one, v.x(), v.y(), v.z()};
}

void Rotation::set(const Quaterniond& q) noexcept {
  q_ = q.normalized();
  carry_.setZero();
}

/// Multiplies q by a turn, from the left (`world`) or from the right. The change is (cos - 1) q plus the part of the
/// turn's vector. It is small, and is added with its rounding error kept (Knuth's TwoSum); then the length is corrected
/// to first order. The vector is v + rest. The products with v are exact, because their rounding errors would repeat
/// and add up.
void Rotation::apply(const Vector3d& v, const Vector3d& rest, double cosine_less_one, bool world) noexcept {
  const Vector4d q = q_.coeffs();
  const Vector3d vec = q.head<3>(), carried = carry_.head<3>(), turned = world ? v : Vector3d(-v);
  Vector4d change, small;  // small: terms that are far smaller than those in `change`
  small.head<3>() = cosine_less_one * vec + q.w() * rest + (world ? rest : Vector3d(-rest)).cross(vec) +
                    carry_.w() * v + turned.cross(carried);
  small.w() = cosine_less_one * q.w() - rest.dot(vec) - v.dot(carried);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    change[i] = exactDot({v[i], turned[j], -turned[k]}, {q.w(), vec[k], vec[j]}, small[i]);
  }
  change.w() = exactDot(-v, vec, small.w());
  small += carry_ - excessLength(q, carry_) / 2 * (q + change);
  for (int i = 0; i < 4; ++i) {
    const double sum = q[i] + change[i];
    const double part = sum - q[i];
    const double left = (q[i] - (sum - part)) + (change[i] - part) + small[i];
    q_.coeffs()[i] = sum + left;
    carry_[i] = left - (q_.coeffs()[i] - sum);
  }
  if (!q_.coeffs().allFinite()) set(Quaterniond::Identity());
}

void Rotation::turnWorld(const Vector3d& turn) noexcept {
  const HalfTurn half = halfTurn(turn);
  apply(turn / 2, -half.shortfall * turn, half.cosine_less_one, true);
}
void Rotation::turnBody(const Vector3d& turn) noexcept {
  const HalfTurn half = halfTurn(turn);
  apply(turn / 2, -half.shortfall * turn, half.cosine_less_one, false);
}
void Rotation::turnBody(const SmallTurn& turn) noexcept {
  apply(turn.vector, Vector3d::Zero(), turn.less, false);
}

}  // namespace hapticd::dynamics
