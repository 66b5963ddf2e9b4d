// SPDX-License-Identifier: MIT
/// The work that a model does on a hand, summed up in the servo thread without allocation. A wall gives back at most
/// the work that the hand did on it. A model that gives back more drives the hand, which then buzzes or drifts.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::record {

/// The work of one model on one probe.
class ContactWork {
 public:
  /// [rt] Adds a tick. The work between two ticks is calculated with the mean of their two forces, which is exact for a
  /// spring.
  /// @param number number of the tick; if ticks are missing before it, no work is counted
  /// @param force [N] and position [m] in the world frame
  void add(uint64_t number, const Eigen::Vector3d& force, const Eigen::Vector3d& position) noexcept HSP_RT {
    if (number == next_) {
      const double work = 0.5 * (force + force_).dot(position - position_);
      if (std::isfinite(work)) (work > 0 ? given_ : taken_) += std::abs(work);
    }
    next_ = number + 1;
    force_ = force;
    position_ = position;
  }
  double given() const noexcept { return given_; }  ///< [J] work done on the hand
  double taken() const noexcept { return taken_; }  ///< [J] work that the hand did

 private:
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), position_ = Eigen::Vector3d::Zero();
  uint64_t next_ = UINT64_MAX;  // number of the tick after the last one
  double given_ = 0, taken_ = 0;
};

}  // namespace hapticd::record
