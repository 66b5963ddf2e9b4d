// SPDX-License-Identifier: MIT
/// Between contact and motors, whatever the plugins say: finite, ramped, limited in force, torque, slew, power and
/// impulse, felt only while the enable switch says so, and latched off by a fault until the user clears it. Nothing
/// here ever makes a force larger than it was asked for.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "description/scene.hpp"
#include "hapticd/abi.h"
#include "servo/safety/fault.hpp"
#include "servo/safety/power_bound.hpp"

namespace hapticd::servo {

/// The limits that can bind, in the order in which they are applied.
enum class Limit : uint8_t { kWorkspace, kHeat, kForce, kTorque, kPower, kImpulse, kSlew, kMotors, kWeight, kSample };
constexpr size_t kLimitCount = 10;
const char* nameOf(Limit limit);  ///< "force": the key under limits

/// In how many ticks each limit made the force smaller.
struct Clips {
  std::array<uint64_t, kLimitCount> ticks{};
  uint64_t any = 0;  ///< ticks in which at least one did
};

class Limiter {
 public:
  static constexpr double kImpulseWindow = 0.1;  ///< [s] any window of this length for which limits.impulse holds
  /// [s] At a fault, and when the enable switch is let go, a full force is gone in this time, or in limits.ramp_out if
  /// that is shorter. A tip that nobody holds any more gains energy for as long: with 8.5 N on 75 g, 0.5 mJ. A planned
  /// end takes limits.ramp_out.
  static constexpr double kFaultRamp = 0.002;
  /// [s] A force that was reduced because the samples were old grows back in this time.
  static constexpr double kFreshRamp = 0.02;
  /// [s] over which limits.slew is counted: a step of an encoder is as large at 20 kHz as at 1 kHz, so a bound on each
  /// tick would clip good contact the more, the faster the servo.
  static constexpr double kSlewWindow = 0.001;

  /// [main] @param device_max_force [N] of the device, 0: unknown
  Limiter(const scene::Limits& limits, double device_max_force);

  /// [rt] Limits one wrench. @param position of the tip relative to the device's centre [m], for the workspace limit
  void apply(Eigen::Vector3d& force, Eigen::Vector3d& torque, const Eigen::Vector3d& position,
             double dt) noexcept HSP_RT;

  /// [rt] Judges the speed of the tip [m/s].
  void watchSpeed(double speed) noexcept HSP_RT;
  /// [rt] Judges the tip's velocity [m/s], in the frame of the forces, and keeps it for the power limit.
  void watchVelocity(const Eigen::Vector3d& velocity) noexcept HSP_RT;
  /// [rt] Takes the buttons of the newest sample, for the enable switch; nullopt: there is no good sample.
  void watchButtons(std::optional<uint32_t> buttons) noexcept HSP_RT;
  /// [main] A hold button that was down before the run enables forces, as in recordings of versions that allowed it.
  void enableByFoundPressed() { released_ = true; }
  /// [main] What limits.power must reckon with. @param lag [s] of the velocity that watchVelocity() gets
  /// @param mass [kg] of the arm at its tip, 0: unknown
  void expectMotion(double lag, double mass) { power_.expect(lag, mass); }
  /// [rt] What share of the force the newest sample allows, from 1 to 0 as it ages. Call it before apply().
  void trustSample(double share) noexcept HSP_RT { trusted_ = share; }
  /// [rt] The share of the force that the motors allow, 0 to 1; it holds from the next tick on.
  void spareMotors(double factor) noexcept HSP_RT { heat_factor_ = factor; }
  /// [rt] The motors' own limit, or that of the arm's weight, reduced the torques of this tick.
  void clippedByMotors() noexcept HSP_RT { count(Limit::kMotors); }
  void clippedWeight() noexcept HSP_RT { count(Limit::kWeight); }

  /// [rt] Latches a fault: the force ramps to zero from what it is now. The first fault is kept, unless it ends by
  /// itself: then a graver one takes its place. @param measured for the message, in the unit of the fault
  void trip(Fault fault, double measured = 0) noexcept HSP_RT;

  /// [rt] The motors were cut already: the fault latches, and there is no force left to ramp.
  void cut(Fault fault, double measured) noexcept HSP_RT;

  /// [rt] Called after apply(), if the arm could not be told the force because nobody knows where it is. The rest of a
  /// ramp is not resumed, and a later force grows from zero.
  void sentNothing() noexcept HSP_RT;

  /// [rt] A fault that ends by itself is over, and the force ramps in again. Other faults stay.
  void recover() noexcept HSP_RT;

  /// [rt] Clears a latched fault by the user's order: the force ramps in again once it has ramped out.
  void clear() noexcept HSP_RT;

  Fault fault() const noexcept { return fault_.get(); }          ///< [any]
  Fault recovered() const noexcept { return recovered_.get(); }  ///< [any] the last fault that ended by itself
  double measured() const noexcept { return measured_; }         ///< [main] at the fault
  bool enabled() const noexcept { return enabled_; }             ///< forces are enabled by the switch, if there is one
  bool foundPressed() const noexcept { return found_pressed_; }  ///< the enable switch, and not let go since
  double rampOut() const noexcept { return limits_.ramp_out; }   ///< [s] from full force to none, at a planned end
  const Clips& clips() const noexcept { return clips_; }         ///< [main] after the run
  double maxForce() const noexcept { return max_force_; }        ///< [N] 0: none
  double maxTorque() const noexcept { return limits_.torque; }   ///< [N m] 0: none
  /// [rt] The share of a full force that the ramps allow in this tick, after apply(): 0 to 1.
  double allowed() const noexcept { return fault() == Fault::kNone ? ramp_ : fade_ * ramp_; }
  bool silent() const noexcept { return fault() != Fault::kNone && fade_ == 0; }  ///< the force has ramped down to zero

 private:
  using Vector3d = Eigen::Vector3d;
  void ramp(Vector3d& force, Vector3d& torque, double dt) noexcept HSP_RT;
  void limit(Vector3d& force, Vector3d& torque, const Vector3d& position, double dt) noexcept HSP_RT;
  void limitPower(Vector3d& force) noexcept HSP_RT;
  void limitImpulse(Vector3d& force, double dt) noexcept HSP_RT;
  double faultRamp() const noexcept HSP_RT;
  double workspaceFade(const Vector3d& position) const noexcept HSP_RT;
  void count(Limit limit) noexcept HSP_RT;

  scene::Limits limits_;
  double max_force_;
  double ramp_ = 0;  // from zero to full force, at the start and after a fault was cleared
  double fade_ = 0;  // from the force at a fault to zero
  LatchedFault fault_, recovered_;
  double measured_ = 0;
  // A switch must be pressed, not found pressed: somebody who tapes a button down does not hold it.
  bool enabled_ = true, button_was_down_ = true, released_ = false, found_pressed_ = false;
  bool clipped_ = false;  // in this tick
  bool cleared_ = false;  // cleared by the user while the force was still ramping down
  double heat_factor_ = 1, impulse_ = 0;
  double trusted_ = 1, fresh_ = 1;  // factor for the age of the sample: now, and as it grows again
  Clips clips_;
  PowerBound power_;
  Vector3d fault_force_ = Vector3d::Zero(), fault_torque_ = Vector3d::Zero();
  Vector3d last_force_ = Vector3d::Zero(), last_torque_ = Vector3d::Zero();
  Vector3d slow_force_ = Vector3d::Zero(), slow_torque_ = Vector3d::Zero();  // follow the last ones at limits.slew
};

}  // namespace hapticd::servo
