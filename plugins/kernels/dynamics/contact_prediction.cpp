// SPDX-License-Identifier: MIT
#include "kernels/dynamics/contact_prediction.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

struct Depths {
  double now, deepest;  // [m] at the end of the step if the body keeps its velocity; if it stays
};

/// Predicts a contact whose damper holds back the probe more than the surface pushes.
PredictedContact lettingGo(PredictedContact press, const LastContact& last, const contact::WallForce& wall,
                           const Depths& depth, double closing_speed, double dt) noexcept {
  if (!(depth.deepest > 0) || !(wall.damping > 0) || !std::isfinite(closing_speed)) return press;
  const double elastic = contact::wallForce(last.law, depth.deepest, 0).force;
  const double chord = elastic / depth.deepest * std::max(1.0, last.law.exponent);
  const double force = elastic + wall.damping * closing_speed - chord * (depth.deepest - depth.now);
  press.force = -force * last.normal;
  press.give = (chord * dt + wall.damping) * last.normal * last.normal.transpose();
  press.lets_go = true;
  return press;
}

}  // namespace

PredictedContact predict(const LastContact& last, const Vector3d& probe_now, double closing_speed,
                         const Vector3d& point_velocity, double dt) noexcept {
  PredictedContact press;
  press.point = last.point;
  press.outward = last.normal;
  const Vector3d slide = probe_now - last.probe - dt * point_velocity;  // [m] motion of the probe relative to the body
  const double depth = last.depth - last.normal.dot(slide);
  // If the body moves away from the probe by itself, its change of velocity may bring it back. So the force is extended
  // linearly to negative values.
  const double deepest = std::max(depth, last.depth - last.normal.dot(probe_now - last.probe));
  const contact::WallForce wall = contact::wallForce(last.law, deepest, closing_speed);
  if (!(wall.force > 0)) return lettingGo(press, last, wall, {depth, deepest}, closing_speed, dt);
  // For n < 1 the slope of the chord to depth 0 is used. With the steeper slope of the law itself, a light body would
  // be thrown out.
  const double chord = wall.force / deepest * std::max(1.0, last.law.exponent);
  const double force = wall.force - chord * (deepest - depth);
  const Matrix3d across = last.normal * last.normal.transpose();
  press.force = -force * last.normal;
  press.give = (chord * dt + wall.damping) * across;
  if (last.along_stiffness > 0 || last.along_damping > 0) {
    Vector3d along = last.along - last.along_stiffness * (slide - across * slide);
    const double length = along.norm();
    if (length > last.along_limit) along *= last.along_limit / length;
    press.force -= along;
    press.give += (last.along_stiffness * dt + last.along_damping) * (Matrix3d::Identity() - across);
  }
  return press;
}

}  // namespace hapticd::dynamics
