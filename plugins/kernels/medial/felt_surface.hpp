// SPDX-License-Identifier: MIT
/// A deforming surface that the hand feels: nodes move by their own dynamics, and probes press them through contact
/// springs that never pull.
///
/// The displacement of the contour at one place, inward, is a weighted sum of the nodes' displacements:
/// s = scale * sum of weight_i * (-normal, -1) . x_i.
/// A contact force acts on the nodes through the same weights. So its work on the nodes equals its work on the surface,
/// and no energy is created, wherever the probe slides. `scale` is chosen so that a held press feels the stiffness of
/// the material at its place, whatever nodes are near. With this choice, a force displaces its own place more than any
/// other, and the force of a held press has no part along the surface.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/medial/nodes.hpp"
#include "kernels/medial/viscoelastic.hpp"

namespace hapticd::medial {

/// A node and its share in the displacement of a place, with the derivatives of the share along u and v.
struct PlaceNode {
  uint32_t node = 0;
  double weight = 0, weight_u = 0, weight_v = 0;
};

/// A place of the contour that a probe may press.
struct FeltPlace {
  static constexpr std::size_t kMost = 128;
  std::array<PlaceNode, kMost> nodes;
  std::size_t count = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< outward, unit
  double stiffness = 0;                               ///< [N/m] stiffness that a held press feels here
  /// [1/m] gradients of the foot's u and v over the probe's position
  Eigen::Vector3d toward_u{0, 0, 0}, toward_v{0, 0, 0};
  Eigen::Vector3d tangent_u{0, 0, 0}, tangent_v{0, 0, 0};  ///< [m] tangents of the skeleton along u and v
  double turn = 0;  ///< [1/m] rotation of the normal per metre by which the probe moves aside while its foot stays

  // FeltSurface::fit() computes the following.
  double contact = 0;  ///< [N/m] stiffness of the contact spring
  double scale = 0;    ///< factor of the displacement (see the top of this file)
  double yields = 0;   ///< sum of weight^2 * compliance of the nodes
  /// relative change of `scale` along u and v that comes only from the positions of the nodes
  std::array<double, 2> ripple{0, 0};
};

/// One probe at a surface during one tick.
struct FeltContact {
  FeltPlace place;
  double depth = 0;    ///< [m] depth of the probe below the contour at rest; < 0 outside
  double before = 0;   ///< [m] depth of the probe below the displaced surface at the last tick
  bool known = false;  ///< true if `before` is known
  /// true if the probe did not move to this place but begins or was put here: the surface is then displaced as if this
  /// probe had already pressed it for a long time
  bool placed = false;
  /// true if the probe was not near the surface in the last tick: a surface that has swung out beyond the probe is then
  /// moved back to it, but not below its position at rest
  bool fresh = false;

  double inside = 0;               ///< out: [m] depth of the probe below the displaced surface
  double force = 0;                ///< out: [N] force of the contact spring at the end of the tick
  double mean = 0;                 ///< out: [N] mean force over the tick
  Eigen::Vector3d slope{0, 0, 0};  ///< out: gradient of the surface's displacement at the place of the probe
};

class FeltSurface {
 public:
  /// [main] Prepares the steps of all materials.
  /// @param tissue one per node, or one for all
  /// @param compliance one per node, so that the displacement of most places is nearly right even if `scale` is 1
  /// @param ratio see elementOf()
  /// @param dt [s] length of most ticks
  FeltSurface(Nodes& nodes, const std::vector<Tissue>& tissue, std::vector<double> compliance, double ratio, double dt);

  /// [rt] Computes the contact spring and the scale of a place whose nodes and stiffness are already set.
  void fit(FeltPlace& place) const noexcept;
  /// [rt] Advances all moving nodes by one tick of dt [s] under all contacts. With dt = 0 it only computes the present
  /// forces.
  void advance(double dt, std::span<FeltContact> contacts) noexcept;
  void reset() noexcept;  ///< [rt] puts all nodes back to rest
  /// [rt] Returns the kinetic and elastic energy [J] of nodes and contact springs.
  double energy(std::span<const FeltContact> contacts) const noexcept;
  /// [any] Returns the stiffness of the contact spring divided by that of a held press.
  double contactRatio() const noexcept { return ratio_ * (1 + share_); }
  double settleTime() const noexcept { return settle_; }  ///< [s] time after which a free surface is at rest
  bool branches() const noexcept { return !branch_.empty(); }
  /// [m] displacement to which the branch of node i has relaxed
  const Eigen::Vector4d& relaxed(std::size_t i) const noexcept { return branch_[i]; }
  void setRelaxed(std::size_t i, const Eigen::Vector4d& y) noexcept { branch_[i] = y; }
  std::size_t bytes() const noexcept;

 private:
  struct Material {
    SurfaceElement element, damped;
    ViscoelasticStep step;
    double prepared = -1;    ///< [s] time for which `step` was computed
    double time_scale2 = 0;  ///< [s^2] factor from a squared speed to a squared amplitude
  };
  using Give = std::array<std::array<double, kMaxContacts>, kMaxContacts>;

  void take(const std::vector<Tissue>& tissue, double dt);
  static void prepare(Material& material, double dt) noexcept;
  Material& materialOf(std::size_t node) noexcept { return materials_[which_.empty() ? 0 : which_[node]]; }
  const Material& materialOf(std::size_t node) const noexcept { return materials_[which_.empty() ? 0 : which_[node]]; }
  double shift(const FeltPlace& place) const noexcept;
  double complianceBetween(const FeltPlace& a, const FeltPlace& b, double dt) noexcept;
  void setDisplacement(const FeltPlace& place, double displacement) noexcept;
  void stepFree(double dt) noexcept;
  void stepFreeUniform(const ViscoelasticStep& step) noexcept;
  void solve(double dt, std::span<FeltContact> contacts) noexcept;
  void push(const FeltContact& contact) noexcept;
  void wakeContacts(std::span<const FeltContact> contacts) noexcept;
  bool trySleep() noexcept;
  Eigen::Vector3d slopeAt(const FeltPlace& place) const noexcept;
  Eigen::Vector4d twiceEnergy() const noexcept;
  Eigen::Vector4d twiceEnergyAlike() const noexcept;
  void wake(uint32_t node) noexcept;
  /// True if all nodes have the same material: then the values that depend on it are computed only once.
  bool uniform() const noexcept { return which_.empty(); }

  Nodes* nodes_;
  std::vector<Material> materials_;  ///< the different materials
  std::vector<uint16_t> which_;      ///< material of each node; empty if all have the first one
  std::vector<double> compliance_;
  std::vector<Eigen::Vector4d> branch_;  ///< y of each node (see ViscoelasticStep); empty if there is no relaxation
  std::vector<uint32_t> touched_;        ///< for each node: the last tick in which a contact moved it
  /// shares of the skeleton (three equal values) and of the radius in a displacement
  Eigen::Vector4d shares_;
  double ratio_ = 0, share_ = 0, settle_ = 0;
  uint32_t tick_ = 0;
};

}  // namespace hapticd::medial
