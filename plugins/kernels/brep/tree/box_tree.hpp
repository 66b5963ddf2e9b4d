// SPDX-License-Identifier: MIT
/// A tree of bounding boxes in single precision, four boxes per node. It tells a search for the nearest element which
/// elements it can leave out.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/brep/tree/coarse.hpp"

namespace hapticd::brep {

inline Float4 squareRoots(const Float4& x) noexcept {
  return Float4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}

/// The boxes of four children. An unused place has lo = +infinity and hi = -infinity, so it is infinitely far from
/// every probe.
struct alignas(64) BoxNode {
  Float4 lo[3], hi[3];
  /// The index of a node if 0 or more. Otherwise the row of elements first to first + count - 1 in the tree's order,
  /// written as ~(8 * first + count - 1).
  std::array<std::int32_t, 4> child{};
  std::array<std::int32_t, 4> row{};  ///< number of the row, for a child that is a row of the first tree
};

/// A row of elements: those with the places first to first + count - 1 in the tree's order.
struct ElementRow {
  std::uint32_t first, count;
};

class BoxTree {
 public:
  static constexpr int kMaxRow = 8;     ///< elements in one row
  static constexpr int kMaxDepth = 60;  ///< most nodes on the way from the root to a row
  static constexpr int kMaxStack = 3 * kMaxDepth + 4;

  /// [main] Builds the tree from the boxes of the elements, with at most `row` elements in a row. Afterwards order()[i]
  /// is the element at place i. All boxes must be finite and not empty.
  void build(std::span<const Eigen::AlignedBox3d> boxes, int row);

  /// [main] Adds a second tree over some of the elements, with the given boxes and at most `row` elements in a row, for
  /// searches of these elements alone. Its nodes are appended to the nodes of the first tree. @param order the indices
  /// of the boxes are appended in the order of the second tree; its rows are ranges of this list. Returns the index of
  /// its root node.
  std::int32_t graft(std::span<const Eigen::AlignedBox3d> boxes, int row, std::vector<std::uint32_t>& order);

  const std::vector<std::uint32_t>& order() const noexcept { return order_; }
  /// [main] Frees order() and the spare memory of the nodes.
  void forgetOrder() {
    order_ = std::vector<std::uint32_t>();  // "= {}" would keep the memory
    nodes_.shrink_to_fit();
  }
  bool empty() const noexcept { return nodes_.empty(); }
  /// [any] Number of nodes, without those that graft() added.
  std::size_t nodeCount() const noexcept { return own_nodes_; }
  const BoxNode& node(std::int32_t index) const noexcept { return nodes_[static_cast<std::size_t>(index)]; }
  /// [any] The middle of all boxes; the nodes hold coordinates relative to it.
  const Eigen::Vector3d& origin() const noexcept { return origin_; }
  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }
  /// [any] Returns by how much the boxes are enlarged [m], so that rounding the probe to single precision never makes a
  /// box look farther away than it is.
  double margin() const noexcept { return static_cast<double>(margin_); }
  std::int32_t rowCount() const noexcept { return row_count_; }
  std::size_t bytes() const noexcept { return nodes_.size() * sizeof(BoxNode) + order_.size() * sizeof order_[0]; }

  static std::int32_t codeOf(const ElementRow& row) noexcept {
    return ~static_cast<std::int32_t>(8 * row.first + row.count - 1);
  }
  static ElementRow rowOf(std::int32_t child) noexcept {
    const auto code = static_cast<std::uint32_t>(~child);
    return {code / 8, code % 8 + 1};
  }

 private:
  struct Builder;

  std::vector<BoxNode> nodes_;
  std::vector<std::uint32_t> order_;
  Eigen::Vector3d origin_{0, 0, 0};
  Eigen::AlignedBox3d bounds_;
  float margin_ = 0;
  std::int32_t row_count_ = 0;
  std::size_t own_nodes_ = 0;
};

/// A probe in the coordinates of the nodes of one tree.
struct BoxProbe {
  /// [any] `p` is the probe in the frame of the boxes from which the tree was built.
  BoxProbe(const BoxTree& tree, const Eigen::Vector3d& p) noexcept {
    const Eigen::Vector3d q = p - tree.origin();
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<float>(q[axis]);
      at[axis] = Float4{x, x, x, x};
    }
  }
  Float4 at[3];
};

/// The squared distance to a box times this factor is a safe lower bound for every element inside. Rounding a far probe
/// to single precision changes its squared distance by less than 4e-6 of it; for a near probe, the margin of the boxes
/// covers the rounding.
inline constexpr float kBoundShare = 1 - 4e-6F;

/// [rt] Returns lower bounds of the squared distances [m^2] from the probe to the elements in each of four boxes.
inline Float4 boxDistances(const BoxNode& node, const BoxProbe& probe) noexcept {
  constexpr Float4 kZero{};
  Float4 sum{};
  for (int axis = 0; axis < 3; ++axis) {
    const Float4 below = node.lo[axis] - probe.at[axis], above = probe.at[axis] - node.hi[axis];
    const Float4 larger = below > above ? below : above;
    const Float4 beside = larger > kZero ? larger : kZero;
    sum += beside * beside;
  }
  return sum * kBoundShare;
}

}  // namespace hapticd::brep
