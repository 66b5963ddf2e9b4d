// SPDX-License-Identifier: MIT
/// Stands between one shape and the hand: a shape that loses its surface, answers nonsense or says so itself is faded
/// out over a bounded time, and only what it may be trusted with again is faded in.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// Why a shape is not felt.
enum class Trouble : uint8_t {
  kNone,
  kLost,       ///< HSP_E_NUMERIC: reset and tried again
  kNotFinite,  ///< a force or a pose that is not a number: never trusted again
  kBadStatus,  ///< a status that the ABI does not know for step: never trusted again
  kOverrun,    ///< its steps took longer than all shapes may in a tick, again and again: never trusted again
  kJump,       ///< its force jumped beyond the stiffness it claims, again and again: never trusted again
  kPull        ///< its force draws the probe deeper: the wrong sign; never trusted again
};

/// Fades the force of one shape. All times in seconds of the tick.
class Guard {
 public:
  static constexpr double kFadeOut = 0.02;  ///< [s] within this time a failed shape is silent
  static constexpr double kFadeIn = 0.05;   ///< [s] a surface found again must not kick

  /// [rt] Judges the answer of one step.
  Trouble judge(hsp_status status, bool finite) noexcept HSP_RT {
    if (!finite) return enter(Trouble::kNotFinite);
    if (status == HSP_E_NUMERIC) return enter(Trouble::kLost);
    if (status < 0 || status > HSP_DEGRADED) return enter(Trouble::kBadStatus);
    return Trouble::kNone;
  }

  /// [rt] One step took longer than all shapes may, or one force was beyond the claim. Now and then that is forgiven,
  /// `strikes` within a hundred ticks are not.
  Trouble strike(Trouble trouble, int strikes) noexcept HSP_RT {
    strikes_ += kForgivenAfter;
    return strikes_ > (strikes - 1) * kForgivenAfter ? enter(trouble) : Trouble::kNone;
  }

  /// [rt] The factor for the force of this tick; `good` tells whether its step was.
  double gain(bool good, double dt) noexcept HSP_RT {
    if (strikes_ > 0) --strikes_;
    const double step = good ? dt / kFadeIn : -dt / kFadeOut;
    gain_ = std::clamp(gain_ + step, 0.0, 1.0);
    return gain_;
  }

  /// [rt] Silent from now on, until gain() lets it in.
  void silence() noexcept HSP_RT { gain_ = 0; }

  /// The factor of the last tick.
  double gain() const noexcept { return gain_; }
  bool quarantined() const noexcept { return trouble_ > Trouble::kLost; }
  Trouble trouble() const noexcept { return trouble_; }  ///< the gravest so far

 private:
  Trouble enter(Trouble trouble) noexcept HSP_RT {
    if (!quarantined()) trouble_ = trouble;
    return trouble;
  }
  static constexpr int kForgivenAfter = 100;  ///< [ticks]
  int strikes_ = 0;
  double gain_ = 1;  // the first contact of a healthy shape needs no fade: Eq. 4 starts at zero force
  Trouble trouble_ = Trouble::kNone;
};

}  // namespace hapticd::servo
