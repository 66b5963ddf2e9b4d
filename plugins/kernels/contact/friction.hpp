// SPDX-License-Identifier: MIT
/// Stick-slip friction on a traced surface, by a proxy: the point of the surface where the probe sticks.
#pragma once
#include <Eigen/Core>

namespace hapticd::contact {

/// What a surface does to a probe that moves along it.
struct FrictionLaw {
  double static_coefficient = 0;   ///< mu_s: what the stuck probe must overcome
  double dynamic_coefficient = 0;  ///< mu_d <= mu_s: what a sliding probe feels
  double stiffness = 800;          ///< [N/m] of the tangential spring between probe and stuck point
  double viscosity = 0;            ///< [N s/m] drag along the surface, beside the dry friction
};

/// The stuck point of one probe, in the model's frame: it moves with the model, so a moving model drags the probe.
///
/// The force is a spring from the stuck point to the foot. Where it would exceed the limit the stuck point is dragged
/// along, so the force is continuous and the spring only ever gives back what was put in. The limit falls from static
/// to dynamic over a slip as long as the spring's own stretch and returns when the probe sticks again: both changes
/// leave the force of that moment as it is.
class Friction {
 public:
  /// [rt] Force [N] on the probe along the surface: dry friction of at most mu * normal_force, and the drag.
  /// @param foot nearest point of the surface [m], model frame  @param normal outward unit normal there
  /// @param normal_force [N] of the wall, >= 0; 0 or NaN forgets the stuck point
  /// @param velocity of the probe relative to the model [m/s]; only its part along the surface counts
  Eigen::Vector3d step(const FrictionLaw& law, const Eigen::Vector3d& foot, const Eigen::Vector3d& normal,
                       double normal_force, const Eigen::Vector3d& velocity) noexcept;

  /// [rt] The probe left the surface, or jumped.
  void reset() noexcept { stuck_ = slipping_ = false; }

  bool slipping() const noexcept { return slipping_; }    ///< [rt] for the last step
  double energy(const FrictionLaw& law) const noexcept {  ///< [rt] stored in the spring [J]
    return stuck_ ? 0.5 * law.stiffness * stretch_.squaredNorm() : 0;
  }

 private:
  Eigen::Vector3d stretch_{0, 0, 0};  // from the stuck point to the foot, along the surface
  Eigen::Vector3d foot_{0, 0, 0};
  double weakened_ = 0;  // 0: the limit is static; 1: dynamic
  bool stuck_ = false, slipping_ = false;
};

}  // namespace hapticd::contact
