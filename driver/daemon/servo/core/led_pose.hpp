// SPDX-License-Identifier: MIT
/// A pose that a program outside leads: the memory it writes, what of it is taken, and the motion that follows.
#pragma once
#include <cstdint>

#include "hapticd/shape.h"
#include "link/lead.hpp"
#include "servo/core/follow.hpp"

namespace hapticd::servo {

class LedPose {
 public:
  /// How a record without an orientation (four zeros) is understood.
  enum class Turns { kAsked, kNever };
  explicit LedPose(Turns turns = Turns::kAsked) : turns_(turns) {}

  /// [rt] A leader begins. @param slot its memory, valid until end() @param from the present pose, with velocities
  void begin(const link::PoseSlot& slot, const hsp_pose& from) noexcept HSP_RT {
    slot_ = &slot;
    seen_ = refused_ = 0;
    fresh_ = false;
    active_ = true;
    follow_.begin(from);
  }
  /// [rt] The leader has gone: what it led brakes, and stays where that ends.
  void end() noexcept HSP_RT {
    slot_ = nullptr;
    fresh_ = false;
    follow_.release();
  }
  /// [rt] Something else moves the pose from now on.
  void forget() noexcept HSP_RT { active_ = fresh_ = false; }

  /// True if this decides the pose, with a leader or after one has gone.
  bool active() const noexcept { return active_; }
  bool led() const noexcept { return slot_ != nullptr; }

  /// [rt] One tick at t [s], dt [s] after the last: looks once for a new record and moves on. @param epoch
  /// CLOCK_MONOTONIC [s] at t = 0
  void step(double t, double dt, double epoch, hsp_pose& pose) noexcept HSP_RT {
    fresh_ = false;
    if (slot_ != nullptr && slot_->take(seen_, taken_)) judge(t, epoch);
    follow_.step(t, dt, pose);
  }

  /// The record that the last step took, for the recording; nullptr if there was none.
  const hapticd_target* taken() const noexcept { return fresh_ ? &taken_ : nullptr; }
  /// How many records of this leader were refused so far.
  uint64_t refused() const noexcept { return refused_; }
  /// Why the last of them was refused.
  Follow::Refusal why() const noexcept { return why_; }

 private:
  void judge(double t, double epoch) noexcept HSP_RT {
    double* const q = taken_.orientation;
    if (turns_ == Turns::kNever && q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) q[0] = 1;
    if (const auto why = Follow::refusalOf(taken_, epoch + t); why != Follow::Refusal::kNone) {
      why_ = why;
      ++refused_;
      return;
    }
    fresh_ = follow_.aim(taken_, taken_.time > 0 ? taken_.time - epoch : t);
  }

  const link::PoseSlot* slot_ = nullptr;
  uint64_t seen_ = 0, refused_ = 0;
  hapticd_target taken_{};
  Follow follow_;
  Follow::Refusal why_ = Follow::Refusal::kNone;
  Turns turns_;
  bool active_ = false, fresh_ = false;
};

}  // namespace hapticd::servo
