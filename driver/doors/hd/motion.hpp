// SPDX-License-Identifier: MIT
/// Estimates the velocities of an arm from its states in the last ticks. The daemon sends no angular velocity, and the
/// velocity of the tip only if its scene uses it.
#pragma once
#include <array>
#include <cstddef>

#include "hapticd/client.h"

namespace hapticd::hd {

class Motion {
 public:
  void add(const hapticd_state& state);  ///< takes a state that is newer than the last one; ignores all others
  /// Writes the velocity of the tip [m/s], by least squares over the states that were kept; zeros if there are fewer
  /// than two.
  void velocity(double out[3]) const;
  /// Writes the angular velocity [rad/s, world frame], from the oldest kept orientation to the newest.
  void angularVelocity(double out[3]) const;

 private:
  static constexpr size_t kKept = 8;
  const hapticd_state& at(size_t age) const { return kept_[(next_ + kKept - 1 - age) % kKept]; }
  std::array<hapticd_state, kKept> kept_{};
  size_t next_ = 0, count_ = 0;
};

}  // namespace hapticd::hd
