// SPDX-License-Identifier: MIT
/// One arm: its device, kinematics, velocity estimate and limits. Makes a probe from each sample, and joint torques
/// from each force.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/result.hpp"
#include "description/scene.hpp"
#include "host/device_instance.hpp"
#include "servo/arm/admittance.hpp"
#include "servo/arm/client_forces.hpp"
#include "servo/arm/led_hand.hpp"
#include "servo/arm/tip_force.hpp"
#include "servo/arm/weight.hpp"
#include "servo/core/core.hpp"
#include "servo/safety/limiter.hpp"
#include "servo/safety/motor_heat.hpp"
#include "servo/safety/passivity/controller.hpp"
#include "servo/safety/sample_speed.hpp"
#include "servo/velocity/probe_velocity.hpp"
#include "servo/velocity/sample_interval.hpp"

namespace hapticd::servo {

struct ArmOptions {
  double rate = 1000;                        ///< [Hz] rate of the servo
  bool needs_velocity = false;               ///< true if the velocity of the tip must be estimated
  const host::Playback* playback = nullptr;  ///< replay: samples from a recording, instead of the hardware
  scene::Clients clients = {};               ///< settings for programs that push on the arm
  bool found_pressed = false;     ///< for old recordings: a hold button that was down before the run enables forces
  bool full_when_slow = false;    ///< for old recordings: a slow real arm pushes with its full force
  bool former_passivity = false;  ///< for old recordings: a program's steady push counts as created energy
};

class Arm {
 public:
  /// [main] Loads the module and opens the device.
  static Result<std::unique_ptr<Arm>> open(const scene::Device& device, const scene::Servo& servo,
                                           const ArmOptions& options, const host::Services::Log& log);

  /// [main] Starts the device. @param now time of the first read
  Result<void> start(Nanoseconds now, const Eigen::Vector3d& gravity_world);
  void stop() { device_->stop(); }  ///< [main] ends the exchange with the device: motors off

  /// [rt] Reads and writes the device once before the first tick, with motors off. The results are not used.
  void exchangeDry(Nanoseconds now) noexcept HSP_RT;

  /// [rt] Returns the newest sample as a probe in the world frame. A bad sample gives an invalid probe and a fault.
  const Probe& read(Nanoseconds now, double dt) noexcept HSP_RT;

  /// [rt] Limits a wrench (N, N m, world frame), maps it to torques (tau = J^T W + gravity) and hands it to the device.
  /// @param exchange energy that the scene reports, for the passivity controller
  void write(Nanoseconds now, double dt, Eigen::Vector3d force, Eigen::Vector3d torque,
             passivity::Exchange exchange = {}) noexcept HSP_RT;

  /// [any] Switches the motors off at once, while the servo is stuck or the process ends; async-signal-safe. The motors
  /// stay off until clear(). @param after [s] how long the servo was stuck
  void cut(double after) noexcept;
  /// [any] True if the last cut has been sent to the hardware, as far as the module knows; async-signal-safe.
  bool cutLeft() const noexcept { return device_->cutLeft(); }
  /// [rt] Sets whether the motors carry the arm's weight. @param wanted true if something in the scene can be felt
  void carryWeight(bool wanted) noexcept HSP_RT { weight_.carry(wanted); }
  /// [rt] Ends the latched fault and a cut, because the user asked for it.
  void clear() noexcept HSP_RT;

  /// The moment of a tick at which the servo finds that its motors were cut. A replay must find it at the same moment.
  enum class CutFound : uint8_t { kNo, kInWrite, kInRead };
  /// [rt] Returns the moment of a tick at which the servo found that the motors were cut, or kNo if it has found no cut
  /// since the last call.
  CutFound takeCutFound() noexcept HSP_RT { return std::exchange(cut_found_, CutFound::kNo); }
  /// [s] how long the servo had been stuck when the motors were cut
  double cutAfter() const noexcept { return cut_after_.load(); }
  /// [rt] Called before a tick of a replay. It makes the servo find in this tick that the motors were cut, as it did in
  /// the same tick of the recorded run. @param after [s] how long the servo was stuck
  void cutAsThen(CutFound when, double after) noexcept HSP_RT;

  const hdv_info& info() const { return device_->info(); }
  host::DeviceInstance& device() { return *device_; }
  Limiter& limiter() noexcept { return limiter_; }
  /// [any] True if the enable switch was down when the run began and has not been released since. No force flows then.
  bool foundPressed() const noexcept { return found_pressed_.load(std::memory_order_relaxed); }
  /// [any] Returns the device's text for its last fault, "cause; cure", or nullptr if the device gave none.
  const char* trouble() const noexcept { return trouble_.load(std::memory_order_acquire); }
  /// [any] Returns trouble() if only the device can explain this fault; nullptr for every other fault.
  const char* troubleOf(Fault fault) const noexcept {
    if (fault == Fault::kStuck) return stuck_here_.load(std::memory_order_acquire) ? stuck_words_.c_str() : nullptr;
    const bool own = fault == Fault::kDeviceLost || fault == Fault::kDeviceFault || fault == Fault::kStale;
    return own ? trouble() : nullptr;
  }
  const Limiter& limiter() const noexcept { return limiter_; }
  const Eigen::Vector3d& force() const noexcept { return force_; }  ///< [N] world frame, as sent to the device
  const Probe& probe() const noexcept { return probe_; }
  const hdv_sample& sample() const noexcept { return sample_; }     ///< sample that the last read() got
  const hdv_command& command() const noexcept { return command_; }  ///< command that the last write() sent
  const MotorHeat& heat() const noexcept { return heat_; }
  LedHand& hand() noexcept { return hand_; }  ///< the hand that holds a simulated arm
  const LedHand& hand() const noexcept { return hand_; }
  ClientForces& clients() noexcept { return clients_; }  ///< programs that push on the hand
  const ClientForces& clients() const noexcept { return clients_; }
  hsp_status readStatus() const noexcept { return read_status_; }    ///< result of the last read
  hsp_status writeStatus() const noexcept { return write_status_; }  ///< result of the last write
  /// [rt] Returns the force [N] of the hand on the arm, world frame: -pinv(J^T) (tau - gravity), with the measured
  /// joint torques tau and the torques that carry the arm's own weight. Empty if the device measures no torque. In
  /// motion the force includes the inertia of the parts between the load cells and the hand.
  std::optional<Eigen::Vector3d> handForce() const noexcept HSP_RT;
  /// [rt] Gives the Jacobian at the newest sample, world frame: three rows for the position of the tip [m/rad], three
  /// for its rotation [rad/rad], one column per joint, zeros in the other columns. Returns false if it is unknown now.
  bool jacobian(double (&rows)[6][HDV_MAX_JOINTS]) const noexcept HSP_RT;
  /// Returns the compliance control, or nullptr if this arm is driven by force.
  const Admittance* admittance() const noexcept { return admittance_ ? &*admittance_ : nullptr; }
  /// Returns the passivity controller, or nullptr if this arm needs none.
  const passivity::PassivityController* passivity() const noexcept { return passivity_ ? &*passivity_ : nullptr; }
  /// Returns why the arm's rate makes it push less than its limits allow, or "" if it pushes in full.
  const std::string& slowness() const { return slowness_; }
  /// True if the arm can apply torques to the hand. An arm with three joints can only push.
  bool turns() const { return device_->info().joint_count > 3; }
  /// The far end of one link of the arm, world frame.
  struct LinkEnd {
    double position[3], orientation[4];  ///< [m]; orientation of the link: w x y z
  };
  uint32_t linkCount() const { return device_->links() != nullptr ? device_->links()->link_count : 0; }
  /// [rt] Gives the far ends of the links at the newest sample and returns their number: 0 if the device reports no
  /// links, or if they are unknown now.
  uint32_t links(std::array<LinkEnd, HDV_MAX_LINKS>& ends) const noexcept HSP_RT;
  const Eigen::Matrix3d& mount() const noexcept { return R_world_device_; }
  /// [m] origin of the device frame, world frame
  const Eigen::Vector3d& origin() const noexcept { return origin_world_; }
  bool simulated() const noexcept { return (device_->info().capabilities & HDV_C_SIMULATED) != 0; }
  double rampOut() const noexcept { return limiter_.rampOut(); }  ///< [s] time from full force to none

 private:
  Arm(std::unique_ptr<host::DeviceInstance> device, const scene::Device& described, Limiter limiter,
      const ArmOptions& options);
  bool checkSample(hsp_status status, Nanoseconds now) noexcept HSP_RT;
  void trip(Fault fault, double measured = 0) noexcept HSP_RT;
  void findCut(CutFound when) noexcept HSP_RT;
  void recover(double dt, bool pushes) noexcept HSP_RT;
  bool locate() noexcept HSP_RT;
  void watchSamples(const scene::Limits& limits);
  void watchJump() noexcept HSP_RT;
  double trustIn(Nanoseconds age) const noexcept HSP_RT;
  bool comply(double dt, const Eigen::Vector3d& force, const Weight::Torques& weight) noexcept HSP_RT;
  void takeVirtualProbe(Admittance& mass) noexcept HSP_RT;
  /// Returns the torques that carry the arm's own weight in this tick: zeros if the module does not know them, or if
  /// its answer is not finite.
  Weight::Torques weightTorques(const TipJacobian& J, double dt) noexcept HSP_RT;
  void scaleToMotors(const Weight::Torques& gravity) noexcept HSP_RT;
  void heatMotors(double dt) noexcept HSP_RT;
  void send(Nanoseconds now) noexcept HSP_RT;
  void sendsNothing() noexcept HSP_RT;

  std::unique_ptr<host::DeviceInstance> device_;
  Eigen::Matrix3d R_world_device_;
  Eigen::Quaterniond q_world_device_;
  Eigen::Vector3d origin_world_;
  Eigen::Vector3d gravity_device_ = Eigen::Vector3d::Zero();
  std::optional<ProbeVelocity> velocity_;
  std::optional<passivity::PassivityController> passivity_;
  std::optional<Admittance> admittance_;
  LedHand hand_;
  ClientForces clients_;
  Limiter limiter_;
  MotorHeat heat_;
  Weight weight_;
  std::string slowness_;
  std::string name_, stuck_words_;  // name of the device; text of the fault if its module did not return from a call
  std::atomic<bool> stuck_here_{false};
  std::atomic<bool> cut_{false}, taken_{false};  // cut_: the motors were cut. taken_: a thread is inside the module
  std::atomic<double> cut_after_{0};
  std::atomic<bool> found_pressed_{false};
  bool as_found_ = false;          // ArmOptions::found_pressed
  bool former_passivity_ = false;  // ArmOptions::former_passivity
  CutFound cut_found_ = CutFound::kNo;
  bool cut_known_ = false, cut_in_write_ = false;
  hdv_sample sample_{};
  hdv_command command_{};
  hsp_status read_status_ = HSP_OK, write_status_ = HSP_OK;
  std::atomic<const char*> trouble_{nullptr};
  bool well_ = false;  // true if the device had no trouble in this tick
  double calm_ = 0;    // [s] time for which the device has had no trouble, and was at rest or without force
  Eigen::Vector3d calm_at_ = Eigen::Vector3d::Zero();
  uint64_t last_sequence_ = 0;
  Nanoseconds fresh_at_ = 0;
  double fresh_after_ = 0;     // [s] time between the ticks that saw the last two new samples
  double measured_after_ = 0;  // [s] time between the measurements of these samples
  SampleInterval interval_;
  bool fresh_ = false;  // true if the sample of this tick is new
  bool watches_jumps_ = false, tip_known_ = false;
  double fastest_ = 0;        // [m/s] a larger speed between two samples is a jump; 0: unbounded
  double sample_period_ = 0;  // [s] time between two samples of the arm; 0: unknown
  SampleSpeed sample_speed_{0, 0};
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();  // [m] tip at the last good sample, world frame
  Probe probe_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

/// The arms of a run, in the order of the scene.
using Arms = std::vector<std::unique_ptr<Arm>>;

/// [any] True if no arm is real, so that no hand can be hurt.
bool onlySimulated(const Arms& arms) noexcept HSP_RT;

}  // namespace hapticd::servo
