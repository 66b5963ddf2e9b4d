// SPDX-License-Identifier: MIT
/// Contacts that press on a moving body: their forces, predicted for the end of a step, and the change of these forces
/// when the body moves.
#pragma once
#include <Eigen/Core>

#include "kernels/contact/wall.hpp"

namespace hapticd::dynamics {

/// A contact at the end of the last step, in the world frame.
struct LastContact {
  Eigen::Vector3d probe{0, 0, 0};   ///< position of the probe at that time [m]
  Eigen::Vector3d point{0, 0, 0};   ///< point of the surface under the probe [m]
  Eigen::Vector3d normal{0, 0, 1};  ///< outward unit normal of the surface
  Eigen::Vector3d along{0, 0, 0};   ///< friction force on the probe, along the surface [N]
  contact::WallLaw law;
  /// [m] depth of the probe, > 0 inside. If the probe was just outside (depth just below 0), a contact may still begin
  /// within the step
  double depth = 0;
  double along_limit = 0;      ///< [N] greatest friction force
  double along_stiffness = 0;  ///< [N/m] stiffness of the friction while the probe sticks
  double along_damping = 0;    ///< [N s/m] damping along the surface
};

/// One contact in the coming step, in the world frame. A force that is held constant through a step still pushes the
/// body after the body has moved away. Each half swing would then grow by the factor e^(pi w h/4) (w^2 = k/m, step h),
/// which has no bound for a light body. So a PredictedContact has the force at the end of the step, and the amount by
/// which this force falls when the body's velocity changes.
struct PredictedContact {
  Eigen::Vector3d point{0, 0, 0};  ///< [m] point of the body on which the force acts
  /// outward unit normal; no force ever pulls the body in this direction
  Eigen::Vector3d outward{0, 0, 1};
  /// force on the body at the end of the step, if the body keeps its velocity [N]
  Eigen::Vector3d force{0, 0, 0};
  /// [N s/m] reduction of the force per change of the point's velocity
  Eigen::Matrix3d give = Eigen::Matrix3d::Zero();
  /// True if the probe draws back so fast that the surface does not push: the damper's share of `force` then pulls.
  /// Such a contact acts only if the body comes after the probe in this step, so that its force is a push. Without
  /// it a light body on a spring would strike the hand that lets it go (test
  /// Coupling.ALightBodyIsNoBlowToTheHandThatLetsItGo).
  bool lets_go = false;
};

/// [rt] Predicts the contact `last` for the end of a step of dt [s].
/// @param probe_now position of the probe now [m]
/// @param closing_speed speed of the probe relative to the surface [m/s], > 0 if it goes deeper
/// @param point_velocity velocity of the body at the contact [m/s]
PredictedContact predict(const LastContact& last, const Eigen::Vector3d& probe_now, double closing_speed,
                         const Eigen::Vector3d& point_velocity, double dt) noexcept;

}  // namespace hapticd::dynamics
