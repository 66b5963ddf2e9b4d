// SPDX-License-Identifier: MIT
/// The moving parts of a soft body: nodes, which are control points of a skeleton or vertices of a medial mesh. The
/// position and the radius of each node move on a spring and a damper about their values at rest (Corso et al. 2002,
/// sections 3.2 and 3.3).
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/medial/oscillator.hpp"

namespace hapticd::medial {

/// [m] a node with a smaller amplitude counts as at rest: its motion can be neither seen nor felt
inline constexpr double kAsleep = 1e-7;
/// Fraction of the motion that is removed in every tick. The exact step of an undamped node is a rotation, but rounding
/// can turn it into a growing spiral, by a few units in the last place per tick.
inline constexpr double kRoundingLoss = 4e-15;
/// two step lengths dt with a smaller relative difference use the same prepared step
inline constexpr double kSameStep = 1e-9;

struct DeformationOptions {
  /// share of the depth by which the skeleton moves; the radius shrinks by the rest
  double split = 0.5;
  std::array<int, 2> influence{4, 4};  ///< for a grid: p' x q', the number of control points that a contact moves
  int rings = 2;                       ///< for a mesh: how many rings of neighbours a contact moves
  bool dynamics = true;                ///< if false, nodes return to rest at once
  double shear_reach = 0;              ///< [m] for a felt grid: places up to this distance from a contact sink with it
};

/// A node, and the weight with which it contributes to a point of the skeleton.
struct NodeWeight {
  uint32_t node;
  double weight;
};

class Nodes {
 public:
  /// [main] Allocates all memory.
  /// @param material one per node, or one for all
  /// @throws std::invalid_argument for a negative or non-finite number.
  Nodes(std::size_t count, const std::vector<Oscillator>& material, const DeformationOptions& options);

  /// [rt] Advances every awake node by dt [s]. The step is exact for every dt.
  void advance(double dt) noexcept;
  /// [rt] Puts all nodes back to rest and removes the bulge.
  void reset() noexcept;

  /// [rt] Returns the kinetic plus elastic energy of the nodes [J].
  double energy() const noexcept;
  std::size_t awake() const noexcept { return awake_.size(); }  ///< [rt] number of nodes in motion
  std::size_t count() const noexcept { return nodes_.size(); }
  /// [any] Returns the displacement [m] of node i: x, y, z of its position, then its radius.
  const Eigen::Vector4d& displacement(std::size_t i) const noexcept { return nodes_[i].x; }
  /// [any] Returns the rate of change of displacement(i) [m/s].
  const Eigen::Vector4d& rate(std::size_t i) const noexcept { return nodes_[i].v; }
  /// [any] Sets displacement and rate of node i, such as the values of a saved scene.
  void place(std::size_t i, const Eigen::Vector4d& displacement, const Eigen::Vector4d& rate) noexcept;
  /// [s] time after which a free body is at rest, whatever its motion was
  double settleTime() const noexcept { return settle_; }
  double bulge() const noexcept { return bulge_; }  ///< [m] growth of all radii that keeps the volume
  void setBulge(double bulge) noexcept { bulge_ = bulge; }
  std::size_t bytes() const noexcept;

 protected:
  friend class FeltSurface;  // moves the nodes itself if the surface is felt

  /// A contact at which the probe holds the contour.
  struct NodeContact {
    Eigen::Vector3d normal;  ///< outward unit normal
    double depth, speed;     ///< [m] depth of the probe below the contour at rest; [m/s] speed at which it grows
  };
  void clear() noexcept;  ///< [rt] puts all nodes to rest; the bulge stays
  const DeformationOptions& options() const noexcept { return options_; }
  /// [rt] Moves nodes until the contour is not outside the probe. If the probe goes deeper, also raises the speed of
  /// the contour to that of the probe.
  /// @param felt the nodes that shape the contour at the contact
  /// @param moved the nodes that give way; the products of both weights of a node sum to 1
  void yield(const NodeContact& contact, std::span<const NodeWeight> felt, std::span<const NodeWeight> moved) noexcept;

 private:
  struct alignas(32) Node {
    Eigen::Vector4d x = Eigen::Vector4d::Zero(), v = Eigen::Vector4d::Zero();
  };
  struct Material {
    Oscillator oscillator;
    OscillatorStep step;
    double time_scale2 = 0;  ///< [s^2] factor from a squared speed to a squared amplitude
  };

  void prepare(double dt) noexcept;
  void wake(std::size_t node) noexcept;
  const Material& materialOf(std::size_t node) const noexcept { return materials_[which_.empty() ? 0 : which_[node]]; }

  DeformationOptions options_;
  std::vector<Node> nodes_;
  std::vector<Material> materials_;  ///< the different materials
  std::vector<uint16_t> which_;      ///< material of each node; empty if all have the first one
  std::vector<uint32_t> awake_;      ///< indices of the awake nodes; has room for all nodes
  std::vector<uint8_t> is_awake_;
  double prepared_dt_ = -1, settle_ = 0, bulge_ = 0;
};

inline constexpr int kMaxContacts = 16;  ///< most contacts of one body in one tick
/// Number of passes over several contacts. After each pass the contour is nearer to the probes.
inline constexpr int kSweeps = 8;

}  // namespace hapticd::medial
