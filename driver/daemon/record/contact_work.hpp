// SPDX-License-Identifier: MIT
/// The work that a model does on a hand, gathered in the servo thread without allocation. A wall gives back what was
/// pressed into it and no more; a model that gives more drives the hand on, and makes it buzz or drift.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd::record {

/// Of one model on one probe.
class ContactWork {
 public:
  /// [rt] A tick. Between two ticks the force counts as their mean: for a spring that is what it stores, to the last
  /// digits. @param number of the tick: after a gap nothing is counted  @param force [N], position [m] world
  void add(uint64_t number, const Eigen::Vector3d& force, const Eigen::Vector3d& position) noexcept HSP_RT {
    if (number == next_) {
      const double work = 0.5 * (force + force_).dot(position - position_);
      if (std::isfinite(work)) (work > 0 ? given_ : taken_) += std::abs(work);
    }
    next_ = number + 1;
    force_ = force;
    position_ = position;
  }
  double given() const noexcept { return given_; }  ///< [J] to the hand
  double taken() const noexcept { return taken_; }  ///< [J] from it

 private:
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), position_ = Eigen::Vector3d::Zero();
  uint64_t next_ = UINT64_MAX;  // tick that comes
  double given_ = 0, taken_ = 0;
};

}  // namespace hapticd::record
