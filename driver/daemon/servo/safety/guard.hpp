// SPDX-License-Identifier: MIT
/// Decides how much of the force of one shape reaches the hand. The force is faded out if the shape loses its surface,
/// gives a wrong answer or reports an error. It is faded in again only if the shape had lost its surface.
#pragma once
#include <cstdint>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// Why the hand does not feel a shape. After every fault but kLost, the shape is silenced: its force stays off for the
/// rest of the run.
enum class ShapeFault : uint8_t {
  kNone,
  kLost,       ///< the shape lost its surface (HSP_E_NUMERIC): it is reset, and its force may be faded in again
  kNotFinite,  ///< a force or a pose was not a finite number
  kBadStatus,  ///< step() returned a status that the ABI does not allow
  kOverrun,    ///< its steps repeatedly took longer than the budget of all shapes
  kJump,       ///< its force repeatedly jumped by more than its claims allow
  kNotUnit,    ///< a pose had a quaternion whose length is not 1
  kPulls,      ///< its surface pulled the probe in, although the shape claims only to push
  kTwists,     ///< its torque repeatedly jumped by more than its claims allow
  kRunsAway,   ///< a place of it that was touched repeatedly came faster than any tip does
  kGives       ///< it gave the probes energy from nowhere
};

/// Fades the force of one shape. All times are sums of dt.
class Guard {
 public:
  /// [s] The force of a failed shape is zero after this time. Until then a tip that nobody holds gains energy, see
  /// Limiter::kFaultRamp.
  static constexpr double kFadeOut = 0.002;
  static constexpr double kLeave = 0.02;  ///< [s] time in which the force fades out if a request disables the model
  /// [s] duration of a fade-in, so that a surface that is found again does not kick
  static constexpr double kFadeIn = 0.05;
  /// [s] Duration of the fade-in of a model that is added during a run and pushes without a surface. It is long,
  /// because one cannot wait until the tip is outside of such a model.
  static constexpr double kFadeInOfField = 1;

  /// [rt] Judges the answer of one step. @param finite true if all its numbers are finite
  ShapeFault check(hsp_status status, bool finite) noexcept HSP_RT;

  /// [rt] Notes a fault that check() cannot see. Once the shape is silenced, the first fault is kept as the reason.
  ShapeFault enter(ShapeFault fault) noexcept HSP_RT;

  /// [rt] Notes that one step took too long, or that one force was beyond the claim. This becomes a fault if it
  /// happens `strikes` times within a hundred ticks, or, over a longer time, more often than once in a hundred ticks.
  ShapeFault strike(ShapeFault fault, int strikes) noexcept HSP_RT;

  /// [rt] Returns the factor for the force of this tick. @param good true if the step succeeded @param wanted true if
  /// the model is enabled
  double gain(bool good, bool wanted, double dt) noexcept HSP_RT;

  /// [rt] Sets the factor to zero; gain() fades the force in from there.
  void startAtZero() noexcept HSP_RT { gain_ = 0; }

  /// Returns the factor of the last tick.
  double gain() const noexcept { return gain_; }
  bool silenced() const noexcept { return fault_ > ShapeFault::kLost; }
  /// the fault for which the shape was silenced; else kLost or kNone
  ShapeFault fault() const noexcept { return fault_; }

 private:
  static constexpr int kForgivenAfter = 100;  ///< [ticks] after this many ticks one strike is forgiven
  int strikes_ = 0;
  // starts at 1, because the first contact begins with zero force anyway (Eq. 4 of Thompson et al. 1999)
  double gain_ = 1;
  ShapeFault fault_ = ShapeFault::kNone;
};

}  // namespace hapticd::servo
