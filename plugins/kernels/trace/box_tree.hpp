// SPDX-License-Identifier: MIT
/// Bounding boxes of small, nearly flat pieces of patches, in a binary tree: where a global search may stop looking.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::trace {

/// A piece of a patch so flat that Newton from its middle finds the foot that lies on it.
struct Leaf {
  Eigen::AlignedBox3d box;          ///< of the control points of the piece, which enclose it
  Eigen::Array2d middle;            ///< (u, v) to start from
  Eigen::Array2d half;              ///< widths of the piece in (u, v), halved
  Eigen::Vector3d center{0, 0, 0};  ///< S(middle)
  Eigen::Vector3d normal{0, 0, 0};  ///< of the surface there, unit; 0: it has none
  double radius = 0;                ///< [m] of a ball about the center that holds the piece
  double cone = 0;                  ///< [rad] the normal turns by at most about this on the piece
  int patch = 0;

  /// [any] False if no normal of the piece points to p (or straight away): then no foot lies inside it.
  bool mayFace(const Eigen::Vector3d& p) const noexcept;
};

/// A leaf that a query met.
struct LeafHit {
  double distance2 = 0;  ///< [m^2] squared distance to the leaf's box: the piece is no nearer
  int leaf = 0;
};

class BoxTree {
 public:
  /// [main] Cuts a patch into leaves and keeps them.
  void add(const spline::SurfaceData& patch, int index);
  /// [main] Arranges the leaves; call once, after the last add().
  void build();
  /// [sim] All leaves whose boxes come within `radius` [m] of p, nearest box first.
  void within(const Eigen::Vector3d& p, double radius, std::vector<LeafHit>& hits) const;

  const Leaf& leaf(int index) const noexcept { return leaves_[static_cast<std::size_t>(index)]; }
  int leafCount() const noexcept { return static_cast<int>(leaves_.size()); }
  Eigen::AlignedBox3d bounds() const noexcept { return nodes_.empty() ? Eigen::AlignedBox3d() : nodes_.front().box; }
  std::size_t bytes() const noexcept { return leaves_.capacity() * sizeof(Leaf) + nodes_.capacity() * sizeof(Node); }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, count = 0;  ///< leaves; count 0: the children are the next node and node `first`
  };
  int buildNode(int first, int count);

  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
};

}  // namespace hapticd::trace
