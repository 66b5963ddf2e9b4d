// SPDX-License-Identifier: MIT
/// For traced shapes that move under forces: the rigid body, its frame, and the contacts that push it.
#pragma once
#include "kernels/dynamics/rigid_body.hpp"
#include "traced_shape/contact_predictor.hpp"

namespace hapticd {

class DynamicBody {
 public:
  /// [main] Places the body at rest. @param start frame of the model at the start
  /// @param gravity [m/s^2] in the world frame  @throws std::invalid_argument if no body can have this law.
  DynamicBody(const dynamics::RigidBodyLaw& law, const MovingFrame& start, const Eigen::Vector3d& gravity,
              const hsp_activation& activation);

  /// [main] See dynamics::RigidBody::setVelocity().
  void setVelocity(const Eigen::Vector3d& center_velocity, const Eigen::Vector3d& body_rate) noexcept {
    body_.setVelocity(center_velocity, body_rate);
  }

  /// [rt] Moves the body through the step. It is pushed by the contacts that were given to remember() since the last
  /// step. Writes the new pose.
  /// @return the same step, with the positions and velocities of its probes relative to the new pose
  hsp_step move(const hsp_step& step) noexcept HSP_RT;

  /// [rt] Stores the contact of probe `index` with the body, in the model frame. Call it after move(). Probes that are
  /// not stored do not push the body.
  void remember(uint32_t index, const dynamics::LastContact& in_model) noexcept HSP_RT {
    presses_.remember(index, in_model, now_);
  }

  void release() noexcept HSP_RT { presses_.release(); }  ///< [rt] forgets the contacts

  /// [rt] Returns the flags of every contact of the shape (HSP_OUT_*) that say at which end of its range the joint is.
  uint32_t endFlags() const noexcept HSP_RT;
  const dynamics::RigidBody& body() const noexcept { return body_; }

 private:
  dynamics::RigidBody body_;
  MovedProbes probes_;
  ContactPredictor presses_;
  MovingFrame now_;
};

}  // namespace hapticd
