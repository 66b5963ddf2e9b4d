#include "kernels/dynamics/rotation.hpp"

#include <cmath>

namespace hapticd::dynamics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

/// sin(angle/2)/angle and cos(angle/2) - 1, without cancellation.
struct HalfTurn {
  double sine_by_angle, cosine_less_one;
};
HalfTurn halfTurn(double angle) noexcept {
  if (angle < 1e-4) {
    const double a2 = angle * angle;
    return {0.5 - a2 / 48 + a2 * a2 / 3840, -a2 / 8 + a2 * a2 / 384};
  }
  const double quarter = std::sin(angle / 4);
  return {std::sin(angle / 2) / angle, -2 * quarter * quarter};
}

}  // namespace

Quaterniond rotationBy(const Vector3d& turn) noexcept {
  const HalfTurn half = halfTurn(turn.norm());
  const Vector3d v = half.sine_by_angle * turn;
  return {1 + half.cosine_less_one, v.x(), v.y(), v.z()};
}

void Rotation::set(const Quaterniond& q) noexcept {
  q_ = q.normalized();
  carry_.setZero();
}

/// q (or its product with the turn from the other side) changes by (cos - 1) q + the part of the vector: a small
/// change, which is added with its rounding kept (Fast2Sum), and then the length is put right to first order.
void Rotation::apply(const Vector3d& turn, bool world) noexcept {
  const HalfTurn half = halfTurn(turn.norm());
  const Vector3d v = half.sine_by_angle * turn;
  const Vector4d now = q_.coeffs() + carry_;
  const Vector3d vec = now.head<3>();
  Vector4d change;
  const Vector3d side = world ? Vector3d(v.cross(vec)) : Vector3d(vec.cross(v));
  change.head<3>() = half.cosine_less_one * vec + now.w() * v + side;
  change.w() = half.cosine_less_one * now.w() - v.dot(vec);
  // |q|^2 - 1 of the exact pair q_ + carry_, with fused products so that it is known beyond rounding
  const Vector4d q = q_.coeffs();
  double excess = -1;
  double low = 0;
  for (int i = 0; i < 4; ++i) {
    const double square = q[i] * q[i];
    low += std::fma(q[i], q[i], -square) + 2 * q[i] * carry_[i];
    const double sum = excess + square;
    const double part = sum - excess;
    low += (excess - (sum - part)) + (square - part);
    excess = sum;
  }
  change += carry_ - (excess + low) / 2 * q;
  for (int i = 0; i < 4; ++i) {
    const double sum = q[i] + change[i];
    const double part = sum - q[i];
    carry_[i] = (q[i] - (sum - part)) + (change[i] - part);
    q_.coeffs()[i] = sum;
  }
  if (!q_.coeffs().allFinite()) set(Quaterniond::Identity());
}

void Rotation::turnWorld(const Vector3d& turn) noexcept {
  apply(turn, true);
}
void Rotation::turnBody(const Vector3d& turn) noexcept {
  apply(turn, false);
}

}  // namespace hapticd::dynamics
