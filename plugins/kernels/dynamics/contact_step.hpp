// SPDX-License-Identifier: MIT
/// A step of a rigid body under contacts, in the coordinates in which its joint lets it move.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "kernels/dynamics/contact_prediction.hpp"
#include "kernels/dynamics/positive_definite.hpp"

namespace hapticd::dynamics {

/// What resists a change of velocity, and the impulses that cause one, in N coordinates.
template <int N>
struct Balance {
  Eigen::Matrix<double, N, N> resistance = Eigen::Matrix<double, N, N>::Zero();  ///< impulse per change of velocity
  Eigen::Matrix<double, N, 1> impulse = Eigen::Matrix<double, N, 1>::Zero();

  /// [rt] Adds what acts on a point (or turns the body), whose velocity is `rows` times the coordinates.
  void add(const Eigen::Matrix<double, 3, N>& rows, const Eigen::Matrix3d& resists,
           const Eigen::Vector3d& acts) noexcept {
    resistance += rows.transpose() * (resists * rows);
    impulse += rows.transpose() * acts;
  }
};

/// The motion of a free body. Its six coordinates are the velocity of the centre of mass and the angular velocity.
struct FreeMotion {
  static constexpr int kSize = 6;
  Eigen::Vector3d center{0, 0, 0};  ///< centre of mass [m]

  /// [rt] Returns the matrix that maps the coordinates to the velocity of a point. Its transpose maps a force at the
  /// point to forces along the coordinates.
  Eigen::Matrix<double, 3, kSize> at(const Eigen::Vector3d& point) const noexcept {
    const Eigen::Vector3d lever = point - center;
    Eigen::Matrix<double, 3, kSize> rows;
    rows << Eigen::Matrix3d::Identity(),
        Eigen::Matrix3d{{0, lever.z(), -lever.y()}, {-lever.z(), 0, lever.x()}, {lever.y(), -lever.x(), 0}};
    return rows;
  }
  /// [rt] Adds what resists [kg m^2] and causes [N m s] a change of the angular velocity.
  static void addTurn(Balance<kSize>& all, const Eigen::Matrix3d& resists, const Eigen::Vector3d& acts) noexcept {
    all.resistance.bottomRightCorner<3, 3>() += resists;
    all.impulse.tail<3>() += acts;
  }
};

/// The motion of a body on a hinge or slider. Its coordinate is the rate of the joint [rad/s or m/s].
struct JointMotion {
  static constexpr int kSize = 1;
  bool turns = true;               ///< true for a hinge
  Eigen::Vector3d axis{0, 1, 0};   ///< unit vector
  Eigen::Vector3d pivot{0, 0, 0};  ///< point on the axis of a hinge [m]

  Eigen::Vector3d at(const Eigen::Vector3d& point) const noexcept {  ///< [rt] as of FreeMotion
    return turns ? axis.cross(point - pivot) : axis;
  }
  void addTurn(Balance<kSize>& all, const Eigen::Matrix3d& resists, const Eigen::Vector3d& acts) const noexcept {
    if (turns) all.add(axis, resists, acts);
  }
};

/// One step by backward Euler, in the coordinates of `Motion`, in the world frame.
template <class Motion>
class ContactStep {
 public:
  using Vector = Eigen::Matrix<double, Motion::kSize, 1>;

  /// [rt] @param own mass and inertia, and springs, drag and weight of the body itself
  ContactStep(const Motion& motion, const Balance<Motion::kSize>& own, std::span<const PredictedContact> presses,
              double dt) noexcept
      : motion_(motion), own_(own), presses_(presses), dt_(dt) {}

  /// [rt] Returns the change of velocity in the step. Only contacts that push at the end of the step act in it, and
  /// which do depends on the motion that they cause, so the step is solved until the same contacts push. If forces of
  /// one solution acted on a body that others move, a light body would be thrown ever faster (test TurningContact.*).
  Vector change() const noexcept {
    constexpr int kRounds = 4;  // bounds the time of a step
    const auto grips = [](const PredictedContact& press) { return !press.lets_go; };
    Vector change = changeUnder(grips);
    const auto settled_for = [&](const auto& acted) {
      return std::all_of(presses_.begin(), presses_.end(),
                         [&](const PredictedContact& press) { return acted(press) == pushesAfter(press, change); });
    };
    bool settled = settled_for(grips);
    for (int round = 0; round < kRounds && !settled; ++round) {
      const auto acts = [this, former = change](const PredictedContact& press) { return pushesAfter(press, former); };
      change = changeUnder(acts);
      settled = settled_for(acts);
    }
    return change;
  }

  /// [rt] Returns true if a contact pushes the body, at the start of the step or at its end after `change`.
  bool touched(const Vector& change) const noexcept {
    return std::any_of(presses_.begin(), presses_.end(), [&](const PredictedContact& press) {
      return pushesAfter(press, Vector::Zero()) || pushesAfter(press, change);
    });
  }

 private:
  /// Returns the change of velocity under those contacts that act, with forces that follow it linearly.
  template <class Acts>
  Vector changeUnder(const Acts& acts) const noexcept {
    Balance<Motion::kSize> all = own_;
    for (const PredictedContact& press : presses_)
      if (acts(press)) all.add(motion_.at(press.point), dt_ * press.give, dt_ * press.force);
    return solvePositiveDefinite<Motion::kSize>(all.resistance, all.impulse);
  }

  /// Returns true if a contact pushes the body at the end of the step, when the body's velocity has changed.
  bool pushesAfter(const PredictedContact& press, const Vector& change) const noexcept {
    return press.outward.dot(press.force - press.give * (motion_.at(press.point) * change)) < 0;
  }

  Motion motion_;
  Balance<Motion::kSize> own_;
  std::span<const PredictedContact> presses_;
  double dt_;
};

}  // namespace hapticd::dynamics
