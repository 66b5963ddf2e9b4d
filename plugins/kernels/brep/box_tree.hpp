// SPDX-License-Identifier: MIT
/// A tree of bounding boxes, four to a node, in single precision: where a search for the nearest element need not look.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace hapticd::brep {

/// Four floats that are compared at once.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 squareRoots(const Float4& x) noexcept {
  return Float4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
}

/// Boxes of four children. An empty place has lo = +infinity and hi = -infinity: it is infinitely far from everything.
struct alignas(64) BoxNode {
  Float4 lo[3], hi[3];
  /// A node (0 or more), or ~(8 * first + count - 1): elements first to first + count - 1 of the tree's order.
  std::array<std::int32_t, 4> child{};
  std::array<std::int32_t, 4> row{};  ///< for a child that is a row: its number among all rows
};

/// The elements for which a child of a node stands.
struct ElementRow {
  std::uint32_t first, count;
};

class BoxTree {
 public:
  static constexpr int kMaxRow = 4;     ///< elements in one row
  static constexpr int kMaxDepth = 60;  ///< nodes on the longest way down
  static constexpr int kMaxStack = 3 * kMaxDepth + 4;

  /// [main] Arranges elements by their boxes, at most `row` of them together. Afterwards order()[i] is the element at
  /// place i. All boxes must be finite and not empty.
  void build(std::span<const Eigen::AlignedBox3d> boxes, int row);

  /// A row of one element as the nodes tell it.
  struct RowPlace {
    std::int32_t child, row;
  };
  /// [main] A second tree over some of the elements, with the boxes given: for those who search these alone. Its nodes
  /// stand behind those of the first, and its rows are those of the first. Returns its root.
  std::int32_t graft(std::span<const Eigen::AlignedBox3d> boxes, std::span<const RowPlace> rows);

  const std::vector<std::uint32_t>& order() const noexcept { return order_; }
  /// [main] Frees order() and all that building left over.
  void forgetOrder() {
    order_ = {};
    nodes_.shrink_to_fit();
  }
  bool empty() const noexcept { return nodes_.empty(); }
  /// [any] Without those that were grafted.
  std::size_t nodeCount() const noexcept { return own_nodes_; }
  const BoxNode& node(std::int32_t index) const noexcept { return nodes_[static_cast<std::size_t>(index)]; }
  /// [any] The middle of all boxes; the nodes hold coordinates relative to it.
  const Eigen::Vector3d& origin() const noexcept { return origin_; }
  const Eigen::AlignedBox3d& bounds() const noexcept { return bounds_; }
  /// [any] How much larger the boxes are, so that a probe in single precision is never farther from them [m].
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

/// A probe as the nodes of one tree see it.
struct BoxProbe {
  /// [any] `p` in the frame of the boxes from which the tree was built.
  BoxProbe(const BoxTree& tree, const Eigen::Vector3d& p) noexcept {
    const Eigen::Vector3d q = p - tree.origin();
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<float>(q[axis]);
      at[axis] = Float4{x, x, x, x};
    }
  }
  Float4 at[3];
};

/// The bound of a box as a distance that no element in it undercuts: rounding of the probe to single precision moves a
/// far probe by less than this share of its distance, and that of a near one is in the margin of the boxes.
inline constexpr float kBoundShare = 1 - 4e-6F;

/// [rt] Lower bounds of the squared distances [m^2] from the probe to the elements in each of four boxes.
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
