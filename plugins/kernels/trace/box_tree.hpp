// SPDX-License-Identifier: MIT
/// Bounding boxes of small, nearly flat pieces of patches, a binary tree for each patch: where a global search may stop
/// looking.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
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
  double distance2 = 0;  ///< [m^2] squared distance to its box, or to that of its patch: the piece is no nearer
  int leaf = 0;
};

class BoxTree {
 public:
  static constexpr double kFlat = 0.03;  ///< 1 - cos 14 deg: Newton goes straight from the middle to the foot
  /// [main] Cuts a patch into leaves and keeps them. @param flat 1 - cos of the angle by which the tangents of a leaf
  /// may lean from their mean
  void add(const spline::SurfaceData& patch, int index, double flat = kFlat);
  /// [main] Arranges the leaves; call once, after the last add().
  void build();
  /// [sim] What a search has to look at, nearest box first: the leaves that may be at most `margin` [m] farther from p
  /// than the nearest point of their part, and one leaf, with a lower bound, for each other patch
  /// within `radius` [m]. @param parts by patch, from 0 to part_count - 1
  void near(const Eigen::Vector3d& p, double radius, double margin, std::span<const int> parts, int part_count,
            std::vector<LeafHit>& hits) const;

  const Leaf& leaf(int index) const noexcept { return leaves_[static_cast<std::size_t>(index)]; }
  int leafCount() const noexcept { return static_cast<int>(leaves_.size()); }
  Eigen::AlignedBox3d bounds() const noexcept;
  std::size_t bytes() const noexcept { return leaves_.capacity() * sizeof(Leaf) + nodes_.capacity() * sizeof(Node); }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, count = 0;  ///< leaves; count 0: the children are the next node and node `first`
    int leaf = 0;              ///< the first below it
  };
  /// One query under way.
  struct Query;
  int buildNode(int first, int count);
  void lookAt(int root, Query& query) const;

  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
  std::vector<int> roots_;  ///< by patch: its node
};

}  // namespace hapticd::trace
