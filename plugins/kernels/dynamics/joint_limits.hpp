// SPDX-License-Identifier: MIT
/// The end stops of a hinge or a slider.
#pragma once
#include <cmath>

namespace hapticd::dynamics {

/// The range of a joint between its two end stops: angles of a hinge [rad], or travels of a slider [m], from the
/// initial pose. Infinite limits mean that there is no stop.
struct JointLimits {
  double lowest = -HUGE_VAL;
  double highest = HUGE_VAL;

  bool given() const noexcept { return std::isfinite(lowest) || std::isfinite(highest); }
};

/// The stop at which a joint stands.
enum class Stop { kNone, kLowest, kHighest };

/// [main] Checks limits. @throws std::invalid_argument unless lowest < highest, and the initial pose, 0, is in the
/// range.
void validate(const JointLimits& limits);

/// [rt] Holds a joint in its range: puts a position beyond a stop back to the stop, and sets a rate into the stop to 0.
/// The stop is inelastic. It takes kinetic energy away and gives none back, so it is passive at every rate of the
/// servo, and a body that is pressed against it does not move at all.
/// @param position [rad or m] @param rate [rad/s or m/s]
/// @return the stop that was reached
Stop holdInRange(const JointLimits& limits, double& position, double& rate) noexcept;

/// [any] Returns the stop at which a joint stands, whether it is pressed against it or only rests there.
Stop stopAt(const JointLimits& limits, double position) noexcept;

}  // namespace hapticd::dynamics
