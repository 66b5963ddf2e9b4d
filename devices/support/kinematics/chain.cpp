// SPDX-License-Identifier: MIT
#include "kinematics/chain.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "kinematics/error_collector.hpp"

namespace hapticd::kinematics {
namespace {

constexpr int kInverseSteps = 200;  ///< most iterations; away from joint limits, damped least squares needs 5 to 30
constexpr double kInverseTolerance = 1e-14;  ///< [m] a smaller error ends the search (rounding at 1 m is 1e-16)
constexpr int kInverseStarts = 10;           ///< number of poses from which the search starts before it gives up
constexpr double kAcceptedError = 1e-12;     ///< [m] largest error of a solution

/// Computes cos and sin of a link twist. For a multiple of pi/2 they are exactly 0, 1 or -1, because the rounded
/// cos(pi/2) = 6e-17 would tilt the axis. An angle such as 1.5708, written with few digits, is not corrected.
void exactTwist(double alpha, double& cosine, double& sine) {
  const double turns = alpha / (M_PI / 2), whole = std::round(turns);
  if (std::abs(turns - whole) > 1e-12) {
    cosine = std::cos(alpha);
    sine = std::sin(alpha);
    return;
  }
  const int quarter = static_cast<int>(std::fmod(std::fmod(whole, 4) + 4, 4));
  cosine = quarter == 0 ? 1 : quarter == 2 ? -1 : 0;
  sine = quarter == 1 ? 1 : quarter == 3 ? -1 : 0;
}

void check(const ChainLink& link, size_t index) {
  const std::string who = "arm.dh[" + std::to_string(index) + "]: joint " + std::to_string(index + 1) + ": ";
  for (const double value : {link.a, link.alpha, link.d, link.theta, link.min, link.max, link.mass})
    if (!std::isfinite(value)) throw std::invalid_argument(who + "a number is not finite; expected finite numbers");
  if (link.min > link.max) {
    char text[120];
    std::snprintf(text, sizeof text, "arm.limits[%zu]: [%g, %g], expected the smaller number first", index, link.min,
                  link.max);
    throw std::invalid_argument(text);
  }
  if (link.mass < 0) throw std::invalid_argument(who + "the mass is negative; expected 0 kg or more");
  if (!link.center.allFinite() || !link.inertia.allFinite())
    throw std::invalid_argument(who + "the centre or inertia is not finite; expected finite numbers");
}

}  // namespace

Chain::Chain(const ChainGeometry& geometry)
    : R_base_(geometry.base.orientation.normalized().toRotationMatrix()),
      R_tool_(geometry.tool.orientation.normalized().toRotationMatrix()),
      base_(geometry.base.position),
      tool_(geometry.tool.position),
      count_(static_cast<int>(geometry.links.size())) {
  if (geometry.links.empty() || geometry.links.size() > kMaxJoints)
    throw std::invalid_argument("a chain of " + std::to_string(geometry.links.size()) + " joints, expected 1 to " +
                                std::to_string(kMaxJoints));
  limits_.min.resize(count_);
  limits_.max.resize(count_);
  ErrorCollector wrong;
  for (size_t i = 0; i < geometry.links.size(); ++i) wrong.attempt([&] { check(geometry.links[i], i); });
  wrong.check();
  for (size_t i = 0; i < geometry.links.size(); ++i) {
    links_[i] = geometry.links[i];
    exactTwist(links_[i].alpha, cos_alpha_[i], sin_alpha_[i]);
    limits_.min[static_cast<int>(i)] = links_[i].min;
    limits_.max[static_cast<int>(i)] = links_[i].max;
  }
}

void Chain::frames(const JointVector& q, ChainFrames& at) const noexcept {
  at.R[0] = R_base_;
  at.o[0] = base_;
  for (int i = 0; i < count_; ++i) {
    const auto n = static_cast<size_t>(i);
    const ChainLink& link = links_[n];
    const double theta = link.theta + (link.sliding ? 0 : q[i]), d = link.d + (link.sliding ? q[i] : 0);
    const double ct = std::cos(theta), st = std::sin(theta), ca = cos_alpha_[n], sa = sin_alpha_[n];
    Eigen::Matrix3d R;
    R << ct, -st * ca, st * sa, st, ct * ca, -ct * sa, 0, sa, ca;
    at.o[n + 1] = at.o[n] + at.R[n] * Eigen::Vector3d(link.a * ct, link.a * st, d);
    at.R[n + 1].noalias() = at.R[n] * R;
  }
}

std::span<const int32_t> Chain::parents() const noexcept {
  static constexpr auto kParents = [] {
    std::array<int32_t, kMaxJoints + 1> before{};
    for (int32_t i = 0; i <= kMaxJoints; ++i) before[static_cast<size_t>(i)] = i - 1;
    return before;
  }();
  return {kParents.data(), static_cast<size_t>(count_) + 1};
}

bool Chain::links(const JointVector& q, std::span<Pose> ends) const noexcept {
  ChainFrames at;
  frames(q, at);
  for (size_t i = 0; i < static_cast<size_t>(count_); ++i) ends[i] = {at.o[i + 1], Eigen::Quaterniond(at.R[i + 1])};
  return forward(q, ends[static_cast<size_t>(count_)]);
}

Eigen::Vector3d Chain::tipOf(const ChainFrames& at) const noexcept {
  const auto last = static_cast<size_t>(count_);
  return at.o[last] + at.R[last] * tool_;
}

bool Chain::forward(const JointVector& q, Pose& tip) const noexcept {
  ChainFrames at;
  frames(q, at);
  tip.position = tipOf(at);
  tip.orientation = Eigen::Quaterniond(Eigen::Matrix3d(at.R[static_cast<size_t>(count_)] * R_tool_));
  return true;
}

Jacobian Chain::jacobianAt(const ChainFrames& at, const Eigen::Vector3d& point, int moving) const noexcept {
  Jacobian J = Jacobian::Zero(6, count_);
  for (int i = 0; i < moving; ++i) {
    const auto n = static_cast<size_t>(i);
    const Eigen::Vector3d z = at.R[n].col(2);
    if (links_[n].sliding) {
      J.col(i).head<3>() = z;
    } else {
      J.col(i).head<3>() = z.cross(point - at.o[n]);
      J.col(i).tail<3>() = z;
    }
  }
  return J;
}

bool Chain::jacobian(const JointVector& q, Jacobian& J) const noexcept {
  ChainFrames at;
  frames(q, at);
  J = jacobianAt(at, tipOf(at), count_);
  return true;
}

bool Chain::gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept {
  ChainFrames at;
  frames(q, at);
  tau.setZero(count_);
  // The loop runs from the tip to the base. Everything that joint i carries acts like one mass at one point.
  double mass = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int i = count_ - 1; i >= 0; --i) {
    const auto n = static_cast<size_t>(i);
    mass += links_[n].mass;
    moment += links_[n].mass * (at.o[n + 1] + at.R[n + 1] * links_[n].center);
    const Eigen::Vector3d z = at.R[n].col(2);
    tau[i] = links_[n].sliding ? -mass * gravity.dot(z) : -z.dot((moment - mass * at.o[n]).cross(gravity));
  }
  return true;
}

JointVector Chain::neutral() const noexcept {
  return 0.5 * (limits_.min + limits_.max);
}

JointVector Chain::stepTowards(const Jacobian& J, const Eigen::Vector3d& error, double lambda,
                               const JointVector& q) const noexcept {
  // A joint at its limit that the step would move beyond the limit is left out of the step. If it were only clamped
  // afterwards, the other joints would not reach the point, although they can reach it without this joint.
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMaxJoints> free = J.topRows<3>();
  JointVector trial = q;
  for (int round = 0; round <= count_; ++round) {
    // lazyProduct(): the code for large matrices is not instantiated; the bits are the same for so few joints
    Eigen::Matrix3d A = free.lazyProduct(free.transpose());
    A.diagonal().array() += lambda * (A.trace() + 1e-300);
    trial = q + free.transpose() * A.ldlt().solve(error);
    bool blocked = false;
    for (int i = 0; i < count_; ++i) {
      const bool low = q[i] <= limits_.min[i] && trial[i] < q[i], high = q[i] >= limits_.max[i] && trial[i] > q[i];
      if (low || high) {
        free.col(i).setZero();
        blocked = true;
      }
    }
    if (!blocked) break;
  }
  return trial.cwiseMax(limits_.min).cwiseMin(limits_.max);
}

bool Chain::reach(const Eigen::Vector3d& position, JointVector& q) const noexcept {
  ChainFrames at;
  frames(q, at);
  Eigen::Vector3d error = position - tipOf(at);
  double lambda = 1e-6;
  for (int step = 0; step < kInverseSteps && error.norm() > kInverseTolerance; ++step) {
    const JointVector trial = stepTowards(jacobianAt(at, tipOf(at), count_), error, lambda, q);
    ChainFrames at_trial;
    frames(trial, at_trial);
    const Eigen::Vector3d trial_error = position - tipOf(at_trial);
    if (trial_error.norm() < error.norm()) {
      q = trial;
      at = at_trial;
      error = trial_error;
      lambda = std::max(lambda * 0.1, 1e-15);
    } else {
      if (lambda > 1e6) break;
      lambda *= 10;
    }
  }
  return error.norm() <= kAcceptedError;
}

bool Chain::inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept {
  if (!position.allFinite() || !q.allFinite()) return false;
  // Starts from the present pose. If limits prevent a solution, also tries the middle pose and bent poses to either
  // side.
  for (int attempt = 0; attempt < kInverseStarts; ++attempt) {
    JointVector x = attempt == 0 ? q : neutral();
    if (attempt > 1)
      for (int i = 0; i < count_; ++i)
        x[i] += ((attempt >> (i % 3)) % 2 == 0 ? 0.25 : -0.25) * (limits_.max[i] - limits_.min[i]);
    x = x.cwiseMax(limits_.min).cwiseMin(limits_.max);
    if (!reach(position, x)) continue;
    q = x;
    return true;
  }
  return false;
}

}  // namespace hapticd::kinematics
