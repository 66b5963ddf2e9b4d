#include "servo/passivity/controller.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::passivity {

void PassivityController::reset() noexcept {
  started_ = false;
  energy_ = damping_ = 0;
  share_ = 1;
  held_.setZero();
  added_.setZero();
}

Eigen::Vector3d PassivityController::update(const Eigen::Vector3d& position, const Eigen::Vector3d& force, double dt,
                                            const Exchange& exchange) noexcept {
  damping_ = 0;
  if (!position.allFinite() || !force.allFinite() || !(dt > 0)) {
    if (position.allFinite()) position_ = position;
    held_ = force.allFinite() ? force : Eigen::Vector3d::Zero();
    added_.setZero();
    started_ = position.allFinite();
    return held_;
  }
  const Eigen::Vector3d way = started_ ? Eigen::Vector3d(position - position_) : Eigen::Vector3d::Zero();
  position_ = position;
  started_ = true;
  energy_ += device_damping_ * way.squaredNorm() / dt - held_.dot(way);
  dissipated_ -= added_.dot(way);
  if (std::isfinite(exchange.supplied)) energy_ += share_ * exchange.supplied;
  if (exchange.recoverable >= 0) energy_ = std::min(energy_, exchange.recoverable);
  Eigen::Vector3d result = force;
  added_.setZero();
  if (force.squaredNorm() == 0) {
    energy_ = 0;
  } else if (energy_ < 0 && way.squaredNorm() > 0) {
    const double speed2 = way.squaredNorm() / (dt * dt);
    damping_ = std::min(max_damping_, -energy_ / (dt * speed2));
    added_ = -damping_ / dt * way;
    result += added_;
  }
  held_ = result;
  share_ = 1;
  return result;
}

void PassivityController::applied(const Eigen::Vector3d& force) noexcept {
  if (!force.allFinite()) return;
  const double wanted = held_.norm();
  share_ = wanted > 0 ? std::min(1.0, force.norm() / wanted) : 1;
  added_ *= share_;
  held_ = force;
}

}  // namespace hapticd::passivity
