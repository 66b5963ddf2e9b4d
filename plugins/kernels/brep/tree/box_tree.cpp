// SPDX-License-Identifier: MIT
#include "kernels/brep/tree/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr int kBins = 16;
constexpr int kTooDeep = 20;  // from this depth on, ranges are halved by count, so that the depth stays bounded

double areaOf(const AlignedBox3d& box) {
  if (box.isEmpty()) return 0;
  const Vector3d s = box.sizes();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

struct Bin {
  AlignedBox3d box;
  std::size_t count = 0;
};

}  // namespace

/// Builds the nodes of a tree from the top down.
struct BoxTree::Builder {
  struct Range {
    std::size_t first = 0, count = 0;
    AlignedBox3d box;
  };

  BoxTree& tree;
  std::span<const AlignedBox3d> boxes;
  std::size_t row;

  Range rangeOf(std::size_t first, std::size_t count) const {
    Range range{first, count, {}};
    for (std::size_t i = first; i < first + count; ++i) range.box.extend(boxes[tree.order_[i]]);
    return range;
  }

  /// Partitions a range in two by the surface area heuristic (Wald 2007, "On fast construction of SAH-based bounding
  /// volume hierarchies"). Returns the place where the second part begins.
  std::size_t split(const Range& range, int depth) const {
    AlignedBox3d centers;
    for (std::size_t i = range.first; i < range.first + range.count; ++i)
      centers.extend(boxes[tree.order_[i]].center());
    Eigen::Index axis = 0;
    const double extent = centers.sizes().maxCoeff(&axis);
    const auto begin = tree.order_.begin() + static_cast<std::ptrdiff_t>(range.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(range.count);
    const auto center = [&](std::uint32_t i) { return boxes[i].min()[axis] + boxes[i].max()[axis]; };
    const auto half = [&] {
      const auto middle = begin + static_cast<std::ptrdiff_t>(range.count / 2);
      std::nth_element(begin, middle, end, [&](auto a, auto b) { return center(a) < center(b); });
      return range.first + range.count / 2;
    };
    if (depth >= kTooDeep || !(extent > 0)) return half();
    const double low = 2 * centers.min()[axis], scale = kBins / (2 * extent) * (1 - 1e-9);
    // If the centers almost coincide, the scale overflows and a place may be no number: it counts as bin 0.
    const auto binOf = [&](std::uint32_t i) {
      const double place = (center(i) - low) * scale;
      return place > 0 ? static_cast<int>(std::min(place, kBins - 1.0)) : 0;
    };
    std::array<Bin, kBins> bins;
    for (auto i = begin; i != end; ++i) {
      Bin& bin = bins[static_cast<std::size_t>(binOf(*i))];
      bin.box.extend(boxes[*i]);
      ++bin.count;
    }
    const int best = cheapest(bins);
    if (best < 0) return half();
    const auto middle = std::partition(begin, end, [&](std::uint32_t i) { return binOf(i) <= best; });
    return range.first + static_cast<std::size_t>(middle - begin);
  }

  /// Returns the last bin of the first part, or -1 if all elements are in one bin.
  static int cheapest(const std::array<Bin, kBins>& bins) {
    std::array<double, kBins> right{};
    AlignedBox3d box;
    std::size_t count = 0;
    for (std::size_t i = kBins; i-- > 1;) {
      box.extend(bins[i].box);
      count += bins[i].count;
      right[i] = count == 0 ? -1 : areaOf(box) * static_cast<double>(count);
    }
    box.setEmpty();
    count = 0;
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
      box.extend(bins[i].box);
      count += bins[i].count;
      if (count == 0 || right[i + 1] < 0) continue;
      const double cost = areaOf(box) * static_cast<double>(count) + right[i + 1];
      if (cost < least) {
        least = cost;
        best = static_cast<int>(i);
      }
    }
    return best;
  }

  /// Cuts a range into up to four ranges; the range with the largest box is split first. Returns their number.
  int cut(const Range& whole, int depth, std::array<Range, 4>& ranges) const {
    int count = 1;
    ranges[0] = whole;
    while (count < 4) {
      int largest = -1;
      for (int i = 0; i < count; ++i) {
        const Range& range = ranges[static_cast<std::size_t>(i)];
        if (range.count > row &&
            (largest < 0 || areaOf(range.box) > areaOf(ranges[static_cast<std::size_t>(largest)].box)))
          largest = i;
      }
      if (largest < 0) break;
      const Range range = ranges[static_cast<std::size_t>(largest)];
      const std::size_t middle = split(range, depth);
      ranges[static_cast<std::size_t>(largest)] = rangeOf(range.first, middle - range.first);
      ranges[static_cast<std::size_t>(count++)] = rangeOf(middle, range.first + range.count - middle);
    }
    return count;
  }

  void setBox(BoxNode& node, int place, const AlignedBox3d& box) const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const auto low = static_cast<float>(box.min()[axis] - tree.origin_[axis]);
      const auto high = static_cast<float>(box.max()[axis] - tree.origin_[axis]);
      node.lo[axis][place] = std::nextafter(low, -kInfinity) - tree.margin_;
      node.hi[axis][place] = std::nextafter(high, kInfinity) + tree.margin_;
    }
  }

  std::int32_t build(const Range& whole, int depth) {
    const auto index = static_cast<std::int32_t>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    BoxNode node;
    for (int axis = 0; axis < 3; ++axis) {
      node.lo[axis] = Float4{kInfinity, kInfinity, kInfinity, kInfinity};
      node.hi[axis] = -node.lo[axis];
    }
    std::array<Range, 4> ranges;
    const int count = cut(whole, depth, ranges);
    for (int i = 0; i < count; ++i) {
      const Range& range = ranges[static_cast<std::size_t>(i)];
      setBox(node, i, range.box);
      const auto at = static_cast<std::size_t>(i);
      if (range.count <= row) {
        node.child[at] = ~static_cast<std::int32_t>(8 * range.first + range.count - 1);
        node.row[at] = tree.row_count_++;
      } else {
        node.child[at] = build(range, depth + 1);
      }
    }
    tree.nodes_[static_cast<std::size_t>(index)] = node;
    return index;
  }
};

void BoxTree::build(std::span<const AlignedBox3d> boxes, int row) {
  nodes_.clear();
  own_nodes_ = 0;
  row_count_ = 0;
  order_.resize(boxes.size());
  bounds_.setEmpty();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    order_[i] = static_cast<std::uint32_t>(i);
    bounds_.extend(boxes[i]);
  }
  if (boxes.empty()) return;
  origin_ = bounds_.center();
  // Rounding a probe to single precision moves it by less than this if it is no farther from the origin than twice the
  // diagonal of the bounds. For probes farther away see kBoundShare.
  margin_ = static_cast<float>(bounds_.diagonal().norm() * std::ldexp(1.0, -21));
  Builder builder{*this, boxes, static_cast<std::size_t>(std::clamp(row, 1, kMaxRow))};
  builder.build(builder.rangeOf(0, boxes.size()), 0);
  own_nodes_ = nodes_.size();
}

std::int32_t BoxTree::graft(std::span<const AlignedBox3d> boxes, int row, std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> own_order = std::move(order_);
  const std::int32_t row_count = row_count_;
  order_.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
  Builder builder{*this, boxes, static_cast<std::size_t>(std::clamp(row, 1, kMaxRow))};
  const std::int32_t root = builder.build(builder.rangeOf(0, boxes.size()), 0);
  const auto base = static_cast<std::uint32_t>(order.size());
  for (std::size_t n = static_cast<std::size_t>(root); n < nodes_.size(); ++n)
    for (std::int32_t& child : nodes_[n].child)
      if (child < 0) child = codeOf({base + rowOf(child).first, rowOf(child).count});
  order.insert(order.end(), order_.begin(), order_.end());
  order_ = std::move(own_order);
  row_count_ = row_count;
  return root;
}

}  // namespace hapticd::brep
