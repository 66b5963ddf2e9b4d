// SPDX-License-Identifier: MIT
/// Stands between one shape and the hand: fades a shape out if it loses its surface, gives a wrong answer or reports an
/// error. Only a shape that lost its surface is faded in again.
#pragma once
#include <cstdint>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// Why a shape is not felt.
enum class ShapeFault : uint8_t {
  kNone,
  kLost,       ///< HSP_E_NUMERIC: the shape is reset and tried again
  kNotFinite,  ///< a force or a pose was not a number: never trusted again
  kBadStatus,  ///< step() returned a status that the ABI does not allow: never trusted again
  kOverrun,    ///< its steps repeatedly took longer than the budget of all shapes: never trusted again
  kJump,       ///< its force repeatedly jumped by more than its claims allow: never trusted again
  kNotUnit,    ///< a pose had a quaternion whose length is not 1: never trusted again
  kPulls,      ///< a surface that claims to push only pulled the probe in: never trusted again
  kTwists      ///< like kJump, but the torque jumped: never trusted again
};

/// Fades the force of one shape. All times are sums of dt.
class Guard {
 public:
  /// [s] The force of a failed shape is zero after this time. Until then a tip that nobody holds gains energy, see
  /// Limiter::kFaultRamp.
  static constexpr double kFadeOut = 0.002;
  static constexpr double kLeave = 0.02;  ///< [s] time in which the force ends if the model is disabled on request
  /// [s] duration of a fade-in, so that a surface that is found again does not kick
  static constexpr double kFadeIn = 0.05;
  /// [s] Duration of the fade-in of a model that is added during a run and pushes without a surface: no hand can be
  /// outside of it.
  static constexpr double kFadeInOfField = 1;

  /// [rt] Judges the answer of one step. @param finite true if all its numbers are finite
  ShapeFault check(hsp_status status, bool finite) noexcept HSP_RT;

  /// [rt] Notes a fault that check() cannot see. Once the shape is quarantined, the first reason is kept.
  ShapeFault enter(ShapeFault fault) noexcept HSP_RT;

  /// [rt] Notes that one step took too long, or that one force was beyond the claim. This becomes a fault if it
  /// happens `strikes` times within a hundred ticks, or, over a longer time, more often than once in a hundred ticks.
  ShapeFault strike(ShapeFault fault, int strikes) noexcept HSP_RT;

  /// [rt] Returns the factor for the force of this tick. @param good true if the step succeeded @param wanted true if
  /// the model is enabled
  double gain(bool good, bool wanted, double dt) noexcept HSP_RT;

  /// [rt] Sets the factor to zero; gain() fades the force in from there.
  void silence() noexcept HSP_RT { gain_ = 0; }

  /// Returns the factor of the last tick.
  double gain() const noexcept { return gain_; }
  bool quarantined() const noexcept { return fault_ > ShapeFault::kLost; }
  ShapeFault fault() const noexcept { return fault_; }  ///< the fault that quarantined it, else the last one

 private:
  static constexpr int kForgivenAfter = 100;  ///< [ticks] after this many ticks one strike is forgiven
  int strikes_ = 0;
  // starts at 1, because the first contact begins with zero force anyway (Eq. 4 of Thompson et al. 1999)
  double gain_ = 1;
  ShapeFault fault_ = ShapeFault::kNone;
};

}  // namespace hapticd::servo
