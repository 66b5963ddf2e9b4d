// SPDX-License-Identifier: MIT
/// Compliance control, the other response model of Thompson et al. 1999 (after Yoshikawa et al. 1995): the hand's force
/// moves a virtual mass with a damper, contacts push the virtual mass, and the arm is made to follow by its own
/// position loop. It serves arms that measure joint torques and are too heavy or too stiff for a hand to push.
#pragma once
#include <Eigen/Core>
#include <string>

#include "description/scene.hpp"
#include "host/device_instance.hpp"
#include "servo/arm/tip_force.hpp"

namespace hapticd::servo {

class Admittance {
 public:
  /// [m] largest distance of the virtual mass from the tip; if the arm lags, the virtual mass waits
  static constexpr double kMaxLead = 0.02;
  /// [1/s] rate at which the joints return to their positions at the start, by motions that do not move the tip
  static constexpr double kHoming = 1;

  /// [main] Returns why compliance control is impossible with this device, or "" if it is possible.
  static std::string refusal(const hdv_info& info);

  /// [main] @param device must be open, and must outlive this object
  Admittance(const scene::Admittance& settings, const host::DeviceInstance& device);

  /// [rt] Puts the virtual mass at rest at the tip of these joints. Returns false if the joints are unknown.
  bool start(const double* joints) noexcept HSP_RT;
  bool started() const noexcept { return started_; }
  void stop() noexcept { started_ = false; }
  /// [rt] Moves the virtual mass, and the joints with it, for dt [s] under a force [N]. The force counts as constant
  /// over a tick, and the velocity under this force is calculated exactly. All vectors are in the device frame.
  /// @param measured tip of the arm [m]
  void step(const Eigen::Vector3d& force, const Eigen::Vector3d& measured, double dt) noexcept HSP_RT;

  const JointVector& joints() const noexcept { return q_; }        ///< joint positions that the arm must follow
  const Eigen::Vector3d& position() const noexcept { return x_; }  ///< position of the virtual mass [m]
  const Eigen::Vector3d& velocity() const noexcept { return v_; }  ///< velocity of the virtual mass [m/s]
  /// orientation of the tip at joints(): w, x, y, z
  const Eigen::Vector4d& orientation() const noexcept { return turn_; }

 private:
  bool locate() noexcept HSP_RT;
  void follow(double dt) noexcept HSP_RT;
  void keepTo(const Eigen::Vector3d& where) noexcept HSP_RT;

  double mass_, damping_;
  const host::DeviceInstance* device_;
  JointVector q_, home_;
  Eigen::Vector3d x_{0, 0, 0}, v_{0, 0, 0};
  Eigen::Vector3d tip_{0, 0, 0};  ///< [m] tip of an arm at the joints q_
  Eigen::Vector4d turn_{1, 0, 0, 0};
  bool started_ = false;
};

}  // namespace hapticd::servo
