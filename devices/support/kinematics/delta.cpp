// SPDX-License-Identifier: MIT
#include "kinematics/delta.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "kinematics/assign_list.hpp"
#include "kinematics/error_collector.hpp"

namespace hapticd::kinematics {
namespace {

constexpr int kMaxNewton = 40;
constexpr double kClosed = 1e-15;      ///< [m^2] the search ends below this residual of the closure: it is rounding
constexpr double kAccepted = 1e-13;    ///< [m^2] largest residual of a solution
constexpr double kLargestStep = 0.03;  ///< [m] longest step; keeps Newton's method on the platform's side of the base

}  // namespace

DeltaGeometry deltaGeometry(const std::vector<double>& lengths, const std::vector<double>& masses,
                            const std::vector<double>& angles) {
  DeltaGeometry g;
  ErrorCollector wrong;
  wrong.attempt([&] { assignList(lengths, "arm.lengths", g.a, g.b, g.c, g.d, g.e, g.f, g.r, g.s); });
  wrong.attempt([&] { assignList(masses, "arm.masses", g.arm_mass, g.rod_mass, g.platform_mass); });
  wrong.attempt([&] { assignList(angles, "arm.angles", g.phi[0], g.phi[1], g.phi[2]); });
  wrong.check();
  return g;
}

Delta::Delta(const DeltaGeometry& geometry)
    : geometry_(geometry), R_device_arm_(geometry.base.orientation.normalized().toRotationMatrix()) {
  if (!(geometry.a > 0 && geometry.b > 0))
    throw std::invalid_argument(
        "arm.lengths: a and b (the first two numbers) are the lengths of an arm and a rod of the delta; "
        "expected more than 0 m");
  if (!(geometry.theta_min < geometry.theta_max))
    throw std::invalid_argument("delta: the angle limits are in the wrong order; expected the smaller angle first");
  for (size_t i = 0; i < 3; ++i) {
    cos_[i] = std::cos(geometry.phi[i]);
    sin_[i] = std::sin(geometry.phi[i]);
  }
  limits_.min = Eigen::Vector3d::Constant(geometry.theta_min);
  limits_.max = Eigen::Vector3d::Constant(geometry.theta_max);
  neutral_ = 0.5 * (limits_.min + limits_.max);
  middle_ = Eigen::Vector3d(0, 0, geometry.a * std::sin(neutral_[0]) + geometry.b);
  if (!solve(neutral_, middle_))
    throw std::invalid_argument(
        "arm.lengths: with these the three arms of the delta do not meet in the middle of their range; expected a, b, "
        "c, d, e, f, r, s in m, in this order");
}

Delta::Closure Delta::closure(size_t arm, const Eigen::Vector3d& p, double theta) const noexcept {
  const DeltaGeometry& g = geometry_;
  const double u = p.x() * cos_[arm] + p.y() * sin_[arm] - g.r + g.c;
  const double v = -p.x() * sin_[arm] + p.y() * cos_[arm] - g.s - g.f;
  const double side2 = g.b * g.b - v * v;  // (b sin theta3)^2
  Closure out{0, 0, Eigen::Vector3d::Zero(), side2 > 0};
  if (!out.valid) return out;
  const double side = std::sqrt(side2), reach = g.d + g.e + side;
  const double along = u - g.a * std::cos(theta), up = p.z() - g.a * std::sin(theta);
  out.value = along * along + up * up - reach * reach;
  const double d_u = 2 * along, d_v = 2 * reach * v / side;
  out.d_p = Eigen::Vector3d(d_u * cos_[arm] - d_v * sin_[arm], d_u * sin_[arm] + d_v * cos_[arm], 2 * up);
  out.d_theta = 2 * g.a * (along * std::sin(theta) - up * std::cos(theta));
  return out;
}

bool Delta::solve(const JointVector& q, Eigen::Vector3d& p) const noexcept {
  Eigen::Vector3d residual, move = Eigen::Vector3d::Zero();
  bool valid = true;
  for (int step = 0; step < kMaxNewton; ++step) {
    Eigen::Matrix3d A;
    valid = true;
    for (int i = 0; i < 3 && valid; ++i) {
      const Closure arm = closure(static_cast<size_t>(i), p, q[i]);
      valid = arm.valid;
      residual[i] = arm.value;
      A.row(i) = arm.d_p;
    }
    if (!valid) {  // the step led to a place where a rod is too short: half of it
      move *= 0.5;
      p -= move;
      continue;
    }
    if (residual.cwiseAbs().maxCoeff() <= kClosed) return true;
    move = -A.inverse() * residual;
    if (!move.allFinite()) return false;
    if (move.norm() > kLargestStep) move *= kLargestStep / move.norm();
    p += move;
    if (move.norm() < 1e-17) break;
  }
  return valid && residual.cwiseAbs().maxCoeff() <= kAccepted;
}

bool Delta::forward(const JointVector& q, Pose& tip) const noexcept {
  Eigen::Vector3d p = middle_;
  if (!solve(q, p)) return false;
  tip.position = geometry_.base.position + R_device_arm_ * p;
  tip.orientation.setIdentity();
  return true;
}

std::span<const int32_t> Delta::parents() const noexcept {
  static constexpr int32_t kParents[] = {-1, -1, -1, 0, 1, 2, 5};
  return kParents;
}

bool Delta::links(const JointVector& q, std::span<Pose> ends) const noexcept {
  const DeltaGeometry& g = geometry_;
  Eigen::Vector3d p = middle_;
  if (!solve(q, p)) return false;
  const auto inDevice = [&](size_t arm, double out, double aside, double up) {
    const Eigen::Vector3d at(out * cos_[arm] - aside * sin_[arm], out * sin_[arm] + aside * cos_[arm], up);
    return Pose{g.base.position + R_device_arm_ * at, Eigen::Quaterniond(R_device_arm_)};
  };
  for (size_t i = 0; i < 3; ++i) {
    const double theta = q[static_cast<int>(i)];
    ends[i] = inDevice(i, g.r + g.a * std::cos(theta), g.s, g.a * std::sin(theta));
    const double u = p.x() * cos_[i] + p.y() * sin_[i] + g.c, v = -p.x() * sin_[i] + p.y() * cos_[i] - g.f;
    ends[3 + i] = inDevice(i, u, v, p.z());
  }
  return forward(q, ends[6]);
}

double Delta::curvature(size_t arm, const Eigen::Vector3d& p, double theta, const Eigen::Vector3d& dp,
                        double d_theta) const noexcept {
  const DeltaGeometry& g = geometry_;
  const double s = std::sin(theta), c = std::cos(theta);
  const double u = p.x() * cos_[arm] + p.y() * sin_[arm] - g.r + g.c;
  const double v = -p.x() * sin_[arm] + p.y() * cos_[arm] - g.s - g.f;
  const double side = std::sqrt(g.b * g.b - v * v), reach = g.d + g.e + side;
  const double d_u = dp.x() * cos_[arm] + dp.y() * sin_[arm], d_v = -dp.x() * sin_[arm] + dp.y() * cos_[arm];
  const double along = u - g.a * c, d_along = d_u + g.a * s * d_theta, dd_along = g.a * c * d_theta * d_theta;
  const double up = p.z() - g.a * s, d_up = dp.z() - g.a * c * d_theta, dd_up = g.a * s * d_theta * d_theta;
  const double d_side = -v * d_v / side, dd_side = -(d_v * d_v + d_side * d_side) / side;
  return 2 * (d_along * d_along + along * dd_along + d_up * d_up + up * dd_up - d_side * d_side - reach * dd_side);
}

bool Delta::motion(const JointVector& q, const JointVector& qd, DeltaMotion& motion) const noexcept {
  Eigen::Vector3d p, curved;
  Eigen::Matrix3d J, A;
  if (!localJacobian(q, p, J, A)) return false;
  const Eigen::Vector3d dp = J * qd;
  for (int i = 0; i < 3; ++i) curved[i] = curvature(static_cast<size_t>(i), p, q[i], dp, qd[i]);
  motion.tip = geometry_.base.position + R_device_arm_ * p;
  motion.J = R_device_arm_ * J;
  motion.swing = R_device_arm_ * (-A.inverse() * curved);
  return motion.swing.allFinite();
}

bool Delta::localJacobian(const JointVector& q, Eigen::Vector3d& p, Eigen::Matrix3d& J,
                          Eigen::Matrix3d& A) const noexcept {
  p = middle_;
  if (!solve(q, p)) return false;
  Eigen::Vector3d b;
  for (int i = 0; i < 3; ++i) {
    const Closure arm = closure(static_cast<size_t>(i), p, q[i]);
    A.row(i) = arm.d_p;
    b[i] = arm.d_theta;
  }
  J = -A.inverse() * b.asDiagonal();  // implicit function theorem: A dp + b dtheta = 0
  return J.allFinite();
}

bool Delta::jacobian(const JointVector& q, Jacobian& J) const noexcept {
  Eigen::Vector3d p;
  Eigen::Matrix3d local, A;
  if (!localJacobian(q, p, local, A)) return false;
  J.setZero(6, 3);
  J.topRows<3>() = R_device_arm_ * local;
  return true;
}

bool Delta::gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept {
  Eigen::Vector3d p;
  Eigen::Matrix3d J, A;
  if (!localJacobian(q, p, J, A)) return false;
  const DeltaGeometry& geometry = geometry_;
  const Eigen::Vector3d g_arm = R_device_arm_.transpose() * gravity;
  tau = -(geometry.platform_mass + 1.5 * geometry.rod_mass) * J.transpose() * g_arm;
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<size_t>(i);
    // The upper arm's centre of mass is at half its length, and half of the rods' mass is at its end.
    const double moment = geometry.a * (0.5 * geometry.arm_mass + 0.5 * geometry.rod_mass);
    const Eigen::Vector3d tangent(-std::sin(q[i]) * cos_[n], -std::sin(q[i]) * sin_[n], std::cos(q[i]));
    tau[i] -= moment * tangent.dot(g_arm);
  }
  return true;
}

bool Delta::inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept {
  const DeltaGeometry& g = geometry_;
  const Eigen::Vector3d p = R_device_arm_.transpose() * (position - g.base.position);
  JointVector found(3);
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<size_t>(i);
    const double u = p.x() * cos_[n] + p.y() * sin_[n] - g.r + g.c;
    const double v = -p.x() * sin_[n] + p.y() * cos_[n] - g.s - g.f;
    if (!(std::abs(v) < g.b)) return false;
    const double reach = g.d + g.e + std::sqrt(g.b * g.b - v * v), distance = std::hypot(u, p.z());
    const double cosine = (distance * distance + g.a * g.a - reach * reach) / (2 * g.a * distance);
    if (!(std::abs(cosine) <= 1)) return false;
    // The upper arm bends outward, so this is the smaller of the two angles.
    found[i] = std::atan2(p.z(), u) - std::acos(cosine);
    if (!(found[i] >= g.theta_min && found[i] <= g.theta_max)) return false;
  }
  // A position has one set of angles, but these angles may also fit a platform behind the base. So a position is in
  // reach only if forward() gives it back.
  Pose check;
  if (!forward(found, check) || (check.position - position).norm() > 1e-9) return false;
  q = found;
  return true;
}

}  // namespace hapticd::kinematics
