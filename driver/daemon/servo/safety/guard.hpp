// SPDX-License-Identifier: MIT
/// Stands between one shape and the hand: a shape that loses its surface, answers nonsense or says so itself is faded
/// out over a bounded time, and only what it may be trusted with again is faded in.
#pragma once
#include <cstdint>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// Why a shape is not felt.
enum class Trouble : uint8_t {
  kNone,
  kLost,       ///< HSP_E_NUMERIC: the shape is reset and tried again
  kNotFinite,  ///< a force or a pose is not a number: never trusted again
  kBadStatus,  ///< step returned a status that the ABI does not allow: never trusted again
  kOverrun,    ///< its steps repeatedly took longer than all shapes may in a tick: never trusted again
  kJump,       ///< its force repeatedly jumped beyond the stiffness it claims: never trusted again
  kNotUnit,    ///< a pose had a quaternion that also stretches: never trusted again
  kPulls,      ///< a surface that only pushes pulled the probe in: never trusted again
  kTwists      ///< its torque jumped, as kJump says of a force: never trusted again
};

/// Fades the force of one shape. All times are in seconds of the tick.
class Guard {
 public:
  /// [s] A failed shape is silent within this time. A tip that nobody holds gains energy for as long, see
  /// Limiter::kFaultRamp.
  static constexpr double kFadeOut = 0.002;
  static constexpr double kLeave = 0.02;   ///< [s] the same where somebody asked for it: a model that is disabled
  static constexpr double kFadeIn = 0.05;  ///< [s] a surface that is found again must not kick
  /// [s] The same for a model that is added during a run and pushes without a surface: no hand can be outside of it.
  static constexpr double kFadeInOfField = 1;

  /// [rt] Judges the answer of one step.
  Trouble judge(hsp_status status, bool finite) noexcept HSP_RT;

  /// [rt] A finding about an answer whose numbers are sound. The gravest one is kept.
  Trouble enter(Trouble trouble) noexcept HSP_RT;

  /// [rt] One step took longer than all shapes may, or one force was beyond the claim. Now and then that is forgiven,
  /// but not `strikes` times within a hundred ticks.
  Trouble strike(Trouble trouble, int strikes) noexcept HSP_RT;

  /// [rt] The factor for the force of this tick. @param good its step succeeded @param wanted it is enabled
  double gain(bool good, bool wanted, double dt) noexcept HSP_RT;

  /// [rt] Silent from now on, until gain() lets the force in.
  void silence() noexcept HSP_RT { gain_ = 0; }

  /// The factor of the last tick.
  double gain() const noexcept { return gain_; }
  bool quarantined() const noexcept { return trouble_ > Trouble::kLost; }
  Trouble trouble() const noexcept { return trouble_; }  ///< the gravest so far

 private:
  static constexpr int kForgivenAfter = 100;  ///< [ticks]
  int strikes_ = 0;
  double gain_ = 1;  // the first contact of a healthy shape needs no fade, since Eq. 4 starts at zero force
  Trouble trouble_ = Trouble::kNone;
};

}  // namespace hapticd::servo
