// SPDX-License-Identifier: MIT
/// A surface that is felt: nodes that move by their own dynamics, pressed through contact springs that never pull.
///
/// The displacement of the contour at one place, inward, is a weighted sum of the nodes' displacements:
/// s = scale * sum of weight_i * (-normal, -1) . x_i. A contact force acts on the nodes through the same weights, so
/// that its work on the nodes is its work on the surface: nothing is made from nothing, wherever the probe slides.
/// `scale` makes the held stiffness of each place that of the material there, whatever nodes are near; a place then
/// yields most to a force on itself, and the force of a held press has no part along the surface.
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
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();       ///< outward, unit
  double stiffness = 0;                                    ///< [N/m] for a held press here
  Eigen::Vector3d toward_u{0, 0, 0}, toward_v{0, 0, 0};    ///< [1/m] gradients of u and v as the probe moves
  Eigen::Vector3d tangent_u{0, 0, 0}, tangent_v{0, 0, 0};  ///< [m] of the skeleton
  double turn = 0;  ///< [1/m] by which the normal turns for a probe that moves aside while its foot stays

  // What FeltSurface::fit() finds.
  double contact = 0;                  ///< [N/m] of the contact spring
  double scale = 0;                    ///< of the displacement
  double yields = 0;                   ///< sum of weight^2 * compliance of the nodes
  std::array<double, 2> ripple{0, 0};  ///< relative change of `scale` along u and v that only the nodes' places cause
};

/// One probe at a surface during one tick.
struct FeltContact {
  FeltPlace place;
  double depth = 0;     ///< [m] of the probe below the contour at rest; negative outside
  double before = 0;    ///< [m] by how much it was inside the present surface at the last tick
  bool known = false;   ///< `before` is known
  bool placed = false;  ///< the probe did not move here: the surface counts as held by it already
  bool fresh = false;   ///< the probe comes from far away: a surface that has swung out beyond it counts as beside it

  double inside = 0;               ///< out: [m] inside the present surface
  double force = 0;                ///< out: [N] of the contact spring now
  double mean = 0;                 ///< out: [N] mean over the tick
  Eigen::Vector3d slope{0, 0, 0};  ///< out: gradient of the surface's displacement where the probe is
};

class FeltSurface {
 public:
  /// [main] `tissue`: one per node, or one for all. `compliance`: one per node, with which the displacement of most
  /// places is nearly right without `scale`. `ratio`: see elementOf(). `dt`: the tick that most steps will have.
  FeltSurface(Nodes& nodes, const std::vector<Tissue>& tissue, std::vector<double> compliance, double ratio, double dt);

  /// [rt] Finds the contact spring and the scale of a place whose nodes and stiffness are known.
  void fit(FeltPlace& place) const noexcept;
  /// [rt] One tick of all moving nodes under all contacts. dt = 0 computes only the present forces.
  void advance(double dt, std::span<FeltContact> contacts) noexcept;
  void reset() noexcept;  ///< [rt] back to rest
  /// [rt] Kinetic and elastic energy [J] of nodes and contact springs.
  double energy(std::span<const FeltContact> contacts) const noexcept;
  /// [any] Contact spring over the stiffness of a held press.
  double contactRatio() const noexcept { return ratio_ * (1 + share_); }
  double settleTime() const noexcept { return settle_; }  ///< [s] after which a free surface is at rest
  bool branches() const noexcept { return !branch_.empty(); }
  const Eigen::Vector4d& relaxed(std::size_t i) const noexcept { return branch_[i]; }  ///< [m] of node i's branch
  void setRelaxed(std::size_t i, const Eigen::Vector4d& y) noexcept { branch_[i] = y; }
  std::size_t bytes() const noexcept;

 private:
  struct Material {
    SurfaceElement element, damped;
    ViscoelasticStep step;
    double prepared = -1;    ///< [s] the time that `step` is for
    double time_scale2 = 0;  ///< [s^2] a speed squared times this is an amplitude squared
  };
  using Give = std::array<std::array<double, kMaxContacts>, kMaxContacts>;

  void take(const std::vector<Tissue>& tissue, double dt);
  static void prepare(Material& material, double dt) noexcept;
  Material& materialOf(std::size_t node) noexcept { return materials_[which_.empty() ? 0 : which_[node]]; }
  const Material& materialOf(std::size_t node) const noexcept { return materials_[which_.empty() ? 0 : which_[node]]; }
  double shift(const FeltPlace& place) const noexcept;
  double give(const FeltPlace& a, const FeltPlace& b, double dt) noexcept;
  void bring(const FeltPlace& place, double displacement) noexcept;
  void swing(double dt) noexcept;
  void swingAlike(const ViscoelasticStep& step) noexcept;
  void solve(double dt, std::span<FeltContact> contacts) noexcept;
  void push(const FeltContact& contact) noexcept;
  void keepAwake(std::span<const FeltContact> contacts) noexcept;
  bool letSleep() noexcept;
  Eigen::Vector3d slopeAt(const FeltPlace& place) const noexcept;
  Eigen::Vector4d twiceEnergy() const noexcept;
  Eigen::Vector4d twiceEnergyAlike() const noexcept;
  void wake(uint32_t node) noexcept;
  /// If all nodes have one material, what depends on it is the same for each, and is computed once.
  bool uniform() const noexcept { return which_.empty(); }

  Nodes* nodes_;
  std::vector<Material> materials_;  ///< the distinct ones
  std::vector<uint16_t> which_;      ///< material of each node; empty: all have the first
  std::vector<double> compliance_;
  std::vector<Eigen::Vector4d> branch_;  ///< y of each node; empty: no relaxation
  std::vector<uint32_t> touched_;        ///< the last tick in which a contact moved a node
  Eigen::Vector4d shares_;               ///< weights of skeleton (three times) and radius in a displacement
  double ratio_ = 0, share_ = 0, settle_ = 0;
  uint32_t tick_ = 0;
};

}  // namespace hapticd::medial
