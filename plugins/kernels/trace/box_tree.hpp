// SPDX-License-Identifier: MIT
/// Bounding boxes of small, nearly flat pieces of patches, as a binary tree for each patch. A global search uses them
/// to skip the pieces that are too far away.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::trace {

/// A piece of a patch that is so flat that Newton's method, started at its middle, finds a foot point on it.
struct Leaf {
  Eigen::AlignedBox3d box;          ///< box of the control points of the piece, which encloses it
  Eigen::Array2d middle;            ///< (u, v) at which Newton's method starts
  Eigen::Array2d half;              ///< half widths of the piece in (u, v)
  Eigen::Vector3d center{0, 0, 0};  ///< S(middle)
  Eigen::Vector3d normal{0, 0, 0};  ///< unit normal of the surface at the middle; 0 if there is none
  double radius = 0;                ///< [m] radius of a ball about the center that contains the piece
  double cone = 0;  ///< [rad] estimate of the largest angle between `normal` and the normals of the piece
  int patch = 0;

  /// [any] Returns false if no normal of the piece points to p or straight away from p. Then no foot lies inside the
  /// piece.
  bool mayFace(const Eigen::Vector3d& p) const noexcept;
};

/// A leaf that near() found.
struct LeafHit {
  /// [m^2] squared distance to the box of the leaf or of its patch: a lower bound of the distance to the piece.
  double distance2 = 0;
  int leaf = 0;
};

class BoxTree {
 public:
  /// 1 - cos of 14 degrees. If the tangents of a leaf turn by no more than this, Newton's method goes directly from
  /// the middle of the leaf to the foot.
  static constexpr double kFlat = 0.03;
  /// [main] Cuts a patch into leaves and stores them. @param flat 1 - cos of the largest angle between the tangents of
  /// a leaf and their mean
  void add(const spline::SurfaceData& patch, int index, double flat = kFlat);
  /// [main] Builds the trees; call it once, after the last add().
  void build();
  /// [sim] Lists the leaves that a search has to examine, those with the nearest boxes first: all leaves that may be at
  /// most `margin` [m] farther from p than the nearest point of their part. For each other patch within `radius` [m]
  /// the list has one leaf, with a lower bound. @param parts part of each patch, from 0 to part_count - 1
  void near(const Eigen::Vector3d& p, double radius, double margin, std::span<const int> parts, int part_count,
            std::vector<LeafHit>& hits) const;

  const Leaf& leaf(int index) const noexcept { return leaves_[static_cast<std::size_t>(index)]; }
  int leafCount() const noexcept { return static_cast<int>(leaves_.size()); }
  Eigen::AlignedBox3d bounds() const noexcept;
  std::size_t bytes() const noexcept { return leaves_.capacity() * sizeof(Leaf) + nodes_.capacity() * sizeof(Node); }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, count = 0;  ///< range of leaves; if count is 0, the children are the next node and node `first`
    int leaf = 0;              ///< the first leaf below this node
  };
  /// The state of one call of near().
  struct Query;
  int buildNode(int first, int count);
  void lookAt(int root, Query& query) const;

  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
  std::vector<int> roots_;  ///< root node of each patch
};

}  // namespace hapticd::trace
