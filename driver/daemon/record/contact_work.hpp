// SPDX-License-Identifier: MIT
/// The work that a model does on a hand, summed up in the servo thread without allocation. A wall gives back at most
/// the work that the hand did on it. A model that gives back more drives the hand, which then buzzes or drifts.
/// Only work inside of the model counts: a magnet that pulls from outside gives the energy that the hand had far away
/// from it, without a fault.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::record {

/// The work of one model on one probe that is in contact with it.
class ContactWork {
 public:
  static constexpr double kSeen = 0.02;    ///< [s] a hand's way in a longer time is no straight line: nobody saw it
  static constexpr double kPeriods = 1.5;  ///< but every tick of a slow servo counts, if it is not much too late

  /// @param period [s] of the servo
  explicit ContactWork(double period = 0) : seen_(std::max(kSeen, kPeriods * period)) {}

  /// [rt] Adds a tick. The work between two ticks is calculated with the mean of their two forces, which is exact for a
  /// spring.
  /// @param number number of the tick; if ticks are missing before it, no work is counted
  /// @param dt [s] since the last tick; if it is too long, no work is counted
  /// @param force [N] and position [m] in the world frame
  /// @param depth [m] depth of the probe; 0 if it is outside
  void add(uint64_t number, double dt, const Eigen::Vector3d& force, const Eigen::Vector3d& position,
           double depth) noexcept HSP_RT {
    if (number == next_ && dt <= seen_) {
      const double work = 0.5 * (force + force_).dot(position - position_);
      if ((depth > 0 || was_inside_) && std::isfinite(work)) (work > 0 ? given_ : taken_) += std::abs(work);
    } else if (const double stored = force.norm() * std::max(depth, 0.0); std::isfinite(stored)) {
      began_ += stored;
    }
    next_ = number + 1;
    force_ = force;
    position_ = position;
    was_inside_ = depth > 0;
  }
  double given() const noexcept { return given_; }  ///< [J] work done on the hand
  double taken() const noexcept { return taken_; }  ///< [J] work that the hand did
  /// [J] At most this energy was stored in the model where the hand was inside it at the first tick (after a gap). The
  /// model may give it to a hand that never pressed.
  double began() const noexcept { return began_; }

 private:
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), position_ = Eigen::Vector3d::Zero();
  uint64_t next_ = UINT64_MAX;  // number of the tick after the last one
  bool was_inside_ = false;     // in the last tick
  double seen_;                 // [s]
  double given_ = 0, taken_ = 0, began_ = 0;
};

}  // namespace hapticd::record
