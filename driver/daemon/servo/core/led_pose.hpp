// SPDX-License-Identifier: MIT
/// A pose that another program leads: reads the program's records from shared memory, checks them, and moves the pose.
#pragma once
#include <cstdint>

#include "hapticd/shape.h"
#include "link/lead.hpp"
#include "servo/core/pose_follower.hpp"

namespace hapticd::servo {

class LedPose {
 public:
  /// Whether records need an orientation. kAsked: a record without one (four zeros) is refused. kNever: zeros mean the
  /// identity.
  enum class Turns { kAsked, kNever };
  explicit LedPose(Turns turns = Turns::kAsked) : turns_(turns) {}

  /// [rt] A leader begins. @param slot the leader's memory, valid until end() @param from the present pose and
  /// velocities
  void begin(const link::PoseSlot& slot, const hsp_pose& from) noexcept HSP_RT {
    slot_ = &slot;
    seen_ = refused_ = 0;
    fresh_ = false;
    active_ = true;
    follow_.begin(from);
  }
  /// [rt] The leader has gone: the pose brakes, and stays where the braking ends.
  void end() noexcept HSP_RT {
    slot_ = nullptr;
    fresh_ = false;
    follow_.release();
  }
  /// [rt] Stops moving the pose, because something else moves it from now on.
  void forget() noexcept HSP_RT { active_ = fresh_ = false; }

  /// True if this object sets the pose: while a leader leads, and after it has gone, until forget().
  bool active() const noexcept { return active_; }
  bool led() const noexcept { return slot_ != nullptr; }

  /// [rt] One tick at t [s], dt [s] after the last one: reads a new record, if there is one, and moves. @param epoch
  /// CLOCK_MONOTONIC [s] at t = 0
  void step(double t, double dt, double epoch, hsp_pose& pose) noexcept HSP_RT {
    fresh_ = false;
    if (slot_ != nullptr && slot_->take(seen_, taken_)) check(t, epoch);
    follow_.step(t, dt, pose);
  }

  /// Returns the record that the last step accepted, for the recording, or nullptr.
  const hapticd_target* taken() const noexcept { return fresh_ ? &taken_ : nullptr; }
  /// Returns how many records of this leader were refused so far.
  uint64_t refused() const noexcept { return refused_; }
  /// Returns why the last refused record was refused.
  PoseFollower::Refusal why() const noexcept { return why_; }

 private:
  void check(double t, double epoch) noexcept HSP_RT {
    double* const q = taken_.orientation;
    if (turns_ == Turns::kNever && q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) q[0] = 1;
    if (const auto why = PoseFollower::refusalOf(taken_, epoch + t); why != PoseFollower::Refusal::kNone) {
      why_ = why;
      ++refused_;
      return;
    }
    fresh_ = follow_.aim(taken_, taken_.time > 0 ? taken_.time - epoch : t);
  }

  const link::PoseSlot* slot_ = nullptr;
  uint64_t seen_ = 0, refused_ = 0;
  hapticd_target taken_{};
  PoseFollower follow_;
  PoseFollower::Refusal why_ = PoseFollower::Refusal::kNone;
  Turns turns_;
  bool active_ = false, fresh_ = false;
};

}  // namespace hapticd::servo
