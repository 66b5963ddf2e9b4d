// SPDX-License-Identifier: MIT
/// For traced shapes that the probes push: predicts the force of each probe on the body in the coming step.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "kernels/dynamics/contact_prediction.hpp"
#include "traced_shape/moving.hpp"

namespace hapticd {

/// The contacts of the last step, by probe, in the world frame.
class ContactPredictor {
 public:
  explicit ContactPredictor(uint32_t most) : last_(most), held_(most, 0) { presses_.reserve(most); }  ///< [main]

  /// [rt] Predicts the contacts at the end of a step, from the present positions of the probes. A probe that has jumped
  /// no longer presses.
  /// @param before frame in which the probes are given
  /// @param velocity_at function that returns the body's velocity at a point, both in the world frame
  template <class VelocityAt>
  std::span<const dynamics::PredictedContact> predict(const hsp_step& step, const MovingFrame& before,
                                                      const VelocityAt& velocity_at) noexcept HSP_RT {
    presses_.clear();
    for (uint32_t i = 0; i < step.count && i < last_.size(); ++i) {
      const hsp_probe& probe = *HSP_AT(const hsp_probe, step.in, step.in_stride, i);
      if (held_[i] == 0 || (probe.flags & HSP_IN_JUMP) != 0) continue;
      const dynamics::LastContact& last = last_[i];
      const Eigen::Vector3d now = before.position + before.orientation * Eigen::Vector3d(probe.position);
      const double closing = -last.normal.dot(before.orientation * Eigen::Vector3d(probe.velocity));
      if (!now.allFinite()) continue;
      const dynamics::PredictedContact press =
          dynamics::predict(last, now, closing, velocity_at(last.point), step.dt_s);
      if (!press.force.isZero(0)) presses_.push_back(press);  // has room for all probes, so it never allocates
    }
    release();
    return presses_;
  }

  /// [rt] Stores the contact of probe `index` in this step. `in_model` is in the model frame, which is at `now` in the
  /// world.
  void remember(uint32_t index, const dynamics::LastContact& in_model, const MovingFrame& now) noexcept HSP_RT {
    if (index >= last_.size()) return;
    dynamics::LastContact& there = last_[index];
    there = in_model;
    there.probe = now.position + now.orientation * in_model.probe;
    there.point = now.position + now.orientation * in_model.point;
    there.normal = now.orientation * in_model.normal;
    there.along = now.orientation * in_model.along;
    held_[index] = 1;
  }

  void release() noexcept HSP_RT { std::fill(held_.begin(), held_.end(), 0); }  ///< [rt] forgets the contacts

 private:
  std::vector<dynamics::LastContact> last_;
  std::vector<char> held_;  ///< by probe: 1 if last_ holds a contact of the last step
  std::vector<dynamics::PredictedContact> presses_;
};

}  // namespace hapticd
