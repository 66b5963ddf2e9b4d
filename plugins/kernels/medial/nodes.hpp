// SPDX-License-Identifier: MIT
/// What moves in a soft body: nodes (control points of a skeleton, vertices of a medial mesh), each a place and a
/// radius on a spring and a damper about where it is at rest (Corso et al. 2002, sections 3.2 and 3.3).
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/medial/oscillator.hpp"

namespace hapticd::medial {

inline constexpr double kAsleep = 1e-7;  ///< [m] amplitude below which no one sees or feels a node move
/// The step of an undamped node is a rotation: rounding may turn it into a growing spiral, by at most a few units in
/// the last place a tick. This much is subtracted.
inline constexpr double kRoundingLoss = 4e-15;
inline constexpr double kSameStep = 1e-9;  ///< two dt with a smaller relative difference share one prepared step

struct DeformationOptions {
  double split = 0.5;                  ///< share of the depth that the skeleton moves; the radius shrinks by the rest
  std::array<int, 2> influence{4, 4};  ///< for a grid: control points that a contact moves, p' x q'
  int rings = 2;                       ///< for a mesh: how many rings of neighbours a contact moves
  bool dynamics = true;                ///< false: nodes return at once
  double shear_reach = 0;              ///< [m] for a felt grid: places this far beside a contact sink with it
};

/// A node and its share in a point of the skeleton.
struct NodeWeight {
  uint32_t node;
  double weight;
};

class Nodes {
 public:
  /// [main] `material`: one per node, or one for all. It allocates for every awake node.
  /// @throws std::invalid_argument for a negative or non-finite number.
  Nodes(std::size_t count, const std::vector<Oscillator>& material, const DeformationOptions& options);

  /// [rt] Lets every node that is awake swing for dt [s]: the exact solution, whatever dt.
  void advance(double dt) noexcept;
  /// [rt] Back to rest.
  void reset() noexcept;

  /// [rt] Kinetic and elastic energy of the nodes [J].
  double energy() const noexcept;
  std::size_t awake() const noexcept { return awake_.size(); }  ///< [rt] nodes in motion
  std::size_t count() const noexcept { return nodes_.size(); }
  /// [any] Displacement of node i: skeleton (x, y, z) and radius [m].
  const Eigen::Vector4d& displacement(std::size_t i) const noexcept { return nodes_[i].x; }
  const Eigen::Vector4d& rate(std::size_t i) const noexcept { return nodes_[i].v; }  ///< [any] its speed [m/s]
  /// [any] Puts node i where it is said to be, such as where it was when a scene was saved.
  void place(std::size_t i, const Eigen::Vector4d& displacement, const Eigen::Vector4d& rate) noexcept;
  double settleTime() const noexcept { return settle_; }  ///< [s] after which a free body is at rest, however it moved
  double bulge() const noexcept { return bulge_; }        ///< [m] by which all radii have grown to keep the volume
  void setBulge(double bulge) noexcept { bulge_ = bulge; }
  std::size_t bytes() const noexcept;

 protected:
  friend class FeltSurface;  // moves the nodes itself if the surface is felt

  /// A contact that holds the contour where the probe is.
  struct Hold {
    Eigen::Vector3d normal;  ///< outward, unit
    double depth, speed;     ///< [m] below the contour at rest; [m/s] at which the probe goes deeper
  };
  void clear() noexcept;  ///< [rt] all nodes to rest; the bulge stays
  const DeformationOptions& options() const noexcept { return options_; }
  /// [rt] Pushes the contour in to the probe if it is outside, and takes it along if it is slower. `felt` are the nodes
  /// that shape the contour there, `moved` those that give way: the sum of their products is 1.
  void yield(const Hold& contact, std::span<const NodeWeight> felt, std::span<const NodeWeight> moved) noexcept;

 private:
  struct alignas(32) Node {
    Eigen::Vector4d x = Eigen::Vector4d::Zero(), v = Eigen::Vector4d::Zero();
  };
  struct Material {
    Oscillator oscillator;
    OscillatorStep step;
    double time_scale2 = 0;  ///< [s^2] a speed squared times this is an amplitude squared
  };

  void prepare(double dt) noexcept;
  void wake(std::size_t node) noexcept;
  const Material& materialOf(std::size_t node) const noexcept { return materials_[which_.empty() ? 0 : which_[node]]; }

  DeformationOptions options_;
  std::vector<Node> nodes_;
  std::vector<Material> materials_;  ///< the distinct ones
  std::vector<uint16_t> which_;      ///< material of each node; empty: all have the first
  std::vector<uint32_t> awake_;      ///< indices, reserved for all
  std::vector<uint8_t> is_awake_;
  double prepared_dt_ = -1, settle_ = 0, bulge_ = 0;
};

inline constexpr int kMaxContacts = 16;  ///< that one body answers at once
inline constexpr int kSweeps = 8;        ///< sweeps over several contacts; each brings the next one nearer to its probe

}  // namespace hapticd::medial
