// SPDX-License-Identifier: MIT
/// Stick-slip friction on a traced surface, by a proxy: the point of the surface where the probe sticks.
#pragma once
#include <Eigen/Core>

namespace hapticd::contact {

/// The friction of a surface against a probe that moves along it.
struct FrictionLaw {
  /// mu_s: a stuck probe slides if the force along the surface exceeds mu_s times the normal force
  double static_coefficient = 0;
  double dynamic_coefficient = 0;  ///< mu_d <= mu_s: the friction on a sliding probe is mu_d times the normal force
  double stiffness = 800;          ///< [N/m] tangential spring between the probe and the stuck point
  double viscosity = 0;            ///< [N s/m] drag along the surface, in addition to the dry friction
};

/// The friction of one probe. Its stuck point is in the model frame: it moves with the model, so a moving model drags
/// the probe.
///
/// The force is that of a spring from the stuck point to the foot point. If it would exceed the limit, the stuck point
/// is dragged along with the foot point. So the force is continuous, and the spring never returns more energy than it
/// received. While the probe slips, the limit falls from the static to the dynamic one over a distance equal to the
/// stretch of the spring. When the probe sticks again, the limit returns to the static one. Neither change makes the
/// force jump.
class Friction {
 public:
  /// [rt] Returns the force [N] on the probe along the surface: dry friction of at most mu * normal_force, plus the
  /// drag.
  /// @param foot foot point of the probe [m], in the model frame
  /// @param normal outward unit normal at the foot
  /// @param normal_force [N] normal force of the wall, >= 0; 0 or NaN forgets the stuck point
  /// @param velocity velocity of the probe relative to the model [m/s]; only its part along the surface counts
  Eigen::Vector3d step(const FrictionLaw& law, const Eigen::Vector3d& foot, const Eigen::Vector3d& normal,
                       double normal_force, const Eigen::Vector3d& velocity) noexcept;

  /// [rt] Forgets the stuck point. Call it if the probe has left the surface, or has jumped.
  void reset() noexcept { stuck_ = slipping_ = false; }

  bool slipping() const noexcept { return slipping_; }    ///< [rt] true if the probe slipped in the last step
  double energy(const FrictionLaw& law) const noexcept {  ///< [rt] energy stored in the spring [J]
    return stuck_ ? 0.5 * law.stiffness * stretch_.squaredNorm() : 0;
  }

 private:
  Eigen::Vector3d stretch_{0, 0, 0};  // vector from the stuck point to the foot, along the surface [m]
  Eigen::Vector3d foot_{0, 0, 0};
  double weakened_ = 0;  // 0: the limit is the static one; 1: the dynamic one; between: in transition
  bool stuck_ = false, slipping_ = false;
};

}  // namespace hapticd::contact
