/// Between contact and motors, whatever the plugins say: finite, ramped, limited in force, slew and speed, and latched
/// off by a fault until the user clears it.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "hapticd/abi.h"
#include "scene/scene.hpp"

namespace hapticd::servo {

/// What took the force away.
enum class Fault : uint8_t {
  kNone,
  kNotFinite,      ///< a force or position that is not a number
  kDeviceLost,     ///< the device cannot be read or written
  kDeviceFault,    ///< the hardware reports a fault
  kStale,          ///< no new sample for too long
  kTooFast,        ///< the tip moved faster than the limit
  kLate,           ///< too many ticks missed in a row
  kNotCalibrated,  ///< the device must be calibrated before it may push
  kStopped         ///< the daemon is stopping
};

/// Words for a fault: what failed, and the command or act that cures it.
const char* describe(Fault fault);

class Limiter {
 public:
  /// [main] @param device_max_force [N] of the device, 0: unknown
  Limiter(const scene::Limits& limits, double device_max_force);

  /// [rt] Limits one wrench. @param position of the tip relative to the device's centre [m], for the workspace limit
  void apply(Eigen::Vector3d& force, Eigen::Vector3d& torque, const Eigen::Vector3d& position,
             double dt) noexcept HSP_RT;

  /// [rt] Judges the speed of the tip [m/s].
  void watchSpeed(double speed) noexcept HSP_RT;

  /// [rt] Latches a fault: the force ramps to zero from what it is now. The first one is kept.
  void trip(Fault fault) noexcept HSP_RT;

  /// [rt] Clears a latched fault by the user's order: the force ramps in again.
  void clear() noexcept HSP_RT;

  Fault fault() const noexcept { return fault_; }
  double rampOut() const noexcept { return limits_.ramp_out; }                   ///< [s] from full force to none
  bool silent() const noexcept { return fault_ != Fault::kNone && fade_ == 0; }  ///< ramped all the way down

 private:
  double workspaceFade(const Eigen::Vector3d& position) const noexcept HSP_RT;

  scene::Limits limits_;
  double max_force_;
  double ramp_ = 0;  // from the start, and after a fault was cleared, to full force
  double fade_ = 0;  // from the force at a fault to none
  Fault fault_ = Fault::kNone;
  Eigen::Vector3d fault_force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d fault_torque_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_torque_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::servo
