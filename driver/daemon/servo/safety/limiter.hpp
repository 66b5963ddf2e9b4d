// SPDX-License-Identifier: MIT
/// Limits every force between contact and motors, whatever the plugins do. Forces are finite, ramped, and limited in
/// size, torque, slew, power and impulse. A force reaches the motors only while the enable switch allows it, and a
/// fault turns it off. The limiter never makes a force larger than asked for.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "description/scene.hpp"
#include "hapticd/abi.h"
#include "servo/safety/fault.hpp"
#include "servo/safety/power_bound.hpp"

namespace hapticd::servo {

/// The limits that can reduce a force. nameOf() lists their names in this order.
enum class Limit : uint8_t { kWorkspace, kHeat, kForce, kTorque, kPower, kImpulse, kSlew, kMotors, kWeight, kSample };
constexpr size_t kLimitCount = 10;
const char* nameOf(Limit limit);  ///< such as "force" for limits.force; a name in reports for programs
const char* keyOf(Limit limit);   ///< key of a device file that sets the limit, such as "limits.force"

/// Counts the ticks in which a limit reduced the force.
struct Clips {
  std::array<uint64_t, kLimitCount> ticks{};
  uint64_t any = 0;  ///< ticks in which at least one limit reduced the force
};

class Limiter {
 public:
  static constexpr double kImpulseWindow = 0.1;  ///< [s] limits.impulse holds for any window of this length
  /// [s] At a fault, or when the enable switch is released, a full force ramps to zero in this time, or in
  /// limits.ramp_out if that is shorter. Until then a tip that nobody holds gains energy: 0.5 mJ with 8.5 N on 75 g. A
  /// planned end takes limits.ramp_out.
  static constexpr double kFaultRamp = 0.002;
  /// [s] A force that was reduced because the sample was old grows back in this time.
  static constexpr double kFreshRamp = 0.02;
  /// [s] Window over which limits.slew is counted. A step of an encoder is as large at 20 kHz as at 1 kHz, so a bound
  /// on each tick would clip good contact more in a faster servo.
  static constexpr double kSlewWindow = 0.001;

  /// [main] @param device_max_force [N] reported by the device, 0: unknown
  Limiter(const scene::Limits& limits, double device_max_force);

  /// [rt] Limits one wrench. @param position of the tip relative to the device's centre [m], for the workspace limit
  void apply(Eigen::Vector3d& force, Eigen::Vector3d& torque, const Eigen::Vector3d& position,
             double dt) noexcept HSP_RT;

  /// [rt] Checks the speed of the tip [m/s] against limits.velocity.
  void watchSpeed(double speed) noexcept HSP_RT;
  /// [rt] Checks the tip's velocity [m/s], in the frame of the forces, and keeps it for the power limit.
  void watchVelocity(const Eigen::Vector3d& velocity) noexcept HSP_RT;
  /// [rt] Takes the buttons of the newest sample, for the enable switch; nullopt if there is no good sample.
  void watchButtons(std::optional<uint32_t> buttons) noexcept HSP_RT;
  /// [main] For recordings of old versions: a hold button that was down before the run enables forces.
  void enableByFoundPressed() { released_ = true; }
  /// [main] Sets two values for limits.power. @param lag [s] delay of the velocity that watchVelocity() gets
  /// @param mass [kg] of the arm at its tip, 0: unknown
  void expectMotion(double lag, double mass) { power_.expect(lag, mass); }
  /// [main] Sets the usual time [s] between two ticks. After a longer gap the force grows by no more than in this time:
  /// the hand has felt nothing of the growth meanwhile.
  void expectPeriod(double period) { period_ = period; }
  /// [rt] Sets the share of the force that the age of the newest sample allows, from 1 (new) to 0 (too old). Call it
  /// before apply().
  void trustSample(double share) noexcept HSP_RT { trusted_ = share; }
  /// [rt] Sets the share of the force that the heat of the motors allows, 0 to 1, from the next tick on.
  void spareMotors(double factor) noexcept HSP_RT { heat_factor_ = factor; }
  /// [rt] Counts that the motors' own limit reduced the torques of this tick.
  void clippedByMotors() noexcept HSP_RT { count(Limit::kMotors); }
  void clippedWeight() noexcept HSP_RT { count(Limit::kWeight); }

  /// [rt] Latches a fault, so that the present force ramps to zero. If a fault is latched already, it is kept, unless
  /// it would end by itself and the new fault would not. @param measured value for the message, in the unit of the
  /// fault
  void trip(Fault fault, double measured = 0) noexcept HSP_RT;

  /// [rt] Latches a fault after the motors were cut. The force is zero at once, without a ramp.
  void cut(Fault fault, double measured) noexcept HSP_RT;

  /// [rt] Called after apply() if the force could not be sent, because the position of the arm is unknown. A ramp to
  /// zero then ends at once, and a later force grows from zero.
  void sentNothing() noexcept HSP_RT;

  /// [rt] Ends a fault that can end by itself, so that the force ramps in again. Other faults stay latched.
  void recover() noexcept HSP_RT;

  /// [rt] Clears a latched fault because the user asked for it. Once the force has ramped out, the force of the models
  /// ramps in.
  void clear() noexcept HSP_RT;

  Fault fault() const noexcept { return fault_.get(); }          ///< [any] the latched fault, or kNone
  Fault recovered() const noexcept { return recovered_.get(); }  ///< [any] the last fault that ended by itself
  /// [main] value measured at the fault, in the unit of the fault
  double measured() const noexcept { return measured_; }
  /// [rt] number of faults so far, those that are over included; a stop is not a fault
  uint32_t faults() const noexcept { return faults_; }
  /// true if there is no enable switch, or if the switch enables forces
  bool enabled() const noexcept { return enabled_; }
  /// true if the enable switch was down at the start and has not been released since
  bool foundPressed() const noexcept { return found_pressed_; }
  double rampOut() const noexcept { return limits_.ramp_out; }  ///< [s] time from full force to zero, at a planned end
  const Clips& clips() const noexcept { return clips_; }        ///< [main] valid only after the run
  double maxForce() const noexcept { return max_force_; }       ///< [N] 0: no limit
  double maxTorque() const noexcept { return limits_.torque; }  ///< [N m] 0: no limit
  /// [rt] Returns the share of a full force that the ramps allow in this tick, 0 to 1. Call it after apply().
  double allowed() const noexcept { return fault() == Fault::kNone ? ramp_ : fade_ * ramp_; }
  /// true if a fault has ramped the force to zero
  bool silent() const noexcept { return fault() != Fault::kNone && fade_ == 0; }

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
  double ramp_ = 0;  // 0 to 1, from zero to full force, at the start and after a fault was cleared
  double fade_ = 0;  // 1 to 0, from the force at a fault to zero
  LatchedFault fault_, recovered_;
  double measured_ = 0;
  uint32_t faults_ = 0;
  // The switch must be pressed during the run. A button that is down from the start may be taped down.
  bool enabled_ = true, button_was_down_ = true, released_ = false, found_pressed_ = false;
  bool clipped_ = false;  // a limit has reduced the force of this tick
  bool cleared_ = false;  // the user cleared the fault while the force was still ramping down
  double heat_factor_ = 1, impulse_ = 0;
  double period_ = std::numeric_limits<double>::infinity();  // [s] see expectPeriod()
  // shares of the force for the age of the sample. trusted_: the share that is allowed now. fresh_: the share in use,
  // which grows slowly
  double trusted_ = 1, fresh_ = 1;
  Clips clips_;
  PowerBound power_;
  Vector3d fault_force_ = Vector3d::Zero(), fault_torque_ = Vector3d::Zero();
  Vector3d last_force_ = Vector3d::Zero(), last_torque_ = Vector3d::Zero();
  // These follow the last force at limits.slew, and the last torque at limits.torque_slew.
  Vector3d slow_force_ = Vector3d::Zero(), slow_torque_ = Vector3d::Zero();
};

}  // namespace hapticd::servo
