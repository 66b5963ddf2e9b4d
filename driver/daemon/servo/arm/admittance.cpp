// SPDX-License-Identifier: MIT
#include "servo/arm/admittance.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

using Eigen::Vector3d;

std::string Admittance::refusal(const hdv_info& info) {
  const bool torque = (info.capabilities & HDV_C_TORQUE) != 0, position = (info.capabilities & HDV_C_POSITION) != 0;
  if (torque && position) return "";
  const char* lacks = torque ? "it takes no position references" : "it measures no joint torques";
  return std::string("admittance: ") + lacks +
         "; compliance control turns measured torques into motion. Leave admittance out (the arm is then driven by "
         "force), or use an arm with torque sensors and a position loop, such as devices/simulated-sarcos.yaml";
}

Admittance::Admittance(const scene::Admittance& settings, const host::DeviceInstance& device)
    : mass_(settings.mass), damping_(settings.damping), device_(&device) {
  q_ = home_ = JointVector::Zero(static_cast<Eigen::Index>(device.info().joint_count));
}

bool Admittance::start(const double* joints) noexcept HSP_RT {
  q_ = home_ = Eigen::Map<const Eigen::VectorXd>(joints, q_.size());
  started_ = q_.allFinite() && locate();
  x_ = tip_;
  v_.setZero();
  return started_;
}

bool Admittance::locate() noexcept HSP_RT {
  return device_->kinematics().forward(device_->handle(), q_.data(), tip_.data(), turn_.data()) >= 0 &&
         tip_.allFinite() && turn_.allFinite();
}

void Admittance::step(const Vector3d& force, const Vector3d& measured, double dt) noexcept HSP_RT {
  if (!started_ || !(dt > 0) || !force.allFinite()) return;
  const double decay = damping_ * dt / mass_;
  const double drift = decay > 1e-9 ? -std::expm1(-decay) / decay : 1;  // solves v' = f/m - (b/m) v over dt
  v_ = std::exp(-decay) * v_ + dt * drift / mass_ * force;
  x_ += dt * v_;  // the new velocity, so that a contact in the loop keeps its energy instead of gaining some
  if (measured.allFinite() && (x_ - measured).norm() > kMaxLead)
    keepTo(measured + kMaxLead * (x_ - measured).normalized());
  follow(dt);
}

/// Moves the joints one step toward the virtual mass. If the joints cannot follow, the virtual mass stops too.
void Admittance::follow(double dt) noexcept HSP_RT {
  // [m] a larger error does not come from curvature within a step, but from a joint limit or a singular pose
  constexpr double kReached = 1e-4;
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor, 6, HDV_MAX_JOINTS> J(6, q_.size());
  const JointVector before = q_;
  if (device_->kinematics().jacobian(device_->handle(), q_.data(), J.data()) == HSP_OK && J.allFinite()) {
    const TipJacobian tip = J.topRows<3>();
    const TipInverse inverse(tip);
    const JointVector home = kHoming * dt * (home_ - q_);
    q_ += inverse.rates(x_ - tip_) + home - inverse.rates(tip * home);
    for (Eigen::Index i = 0; i < q_.size(); ++i)
      q_[i] = std::clamp(q_[i], device_->info().position_min[i], device_->info().position_max[i]);
  }
  if (!q_.allFinite() || !locate()) {
    q_ = before;
    locate();
  }
  if ((x_ - tip_).norm() > kReached) keepTo(tip_);
}

/// Puts the virtual mass at `where`. Removes the part of its velocity that leads away from `where`.
void Admittance::keepTo(const Vector3d& where) noexcept HSP_RT {
  const Vector3d beyond = x_ - where;
  const double out = v_.dot(beyond);
  if (out > 0) v_ -= out / beyond.squaredNorm() * beyond;
  x_ = where;
}

}  // namespace hapticd::servo
