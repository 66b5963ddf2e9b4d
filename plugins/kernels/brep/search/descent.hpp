// SPDX-License-Identifier: MIT
/// How a search goes down a tree of boxes: nearest children first. It records the least bound of the boxes that it
/// leaves out.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "kernels/brep/model/model.hpp"
#include "kernels/brep/tree/box_tree.hpp"
#include "kernels/brep/tree/lanes.hpp"

namespace hapticd::brep {

/// A box that the search has yet to open.
struct DescentEntry {
  float bound;  ///< [m^2] lower bound of the squared distance to everything in the box
  std::int32_t child, row;
};

/// Sorts those of the four children of a node whose bounds are within `limit`, farthest first, and returns their
/// number. `beyond` is lowered to the least bound of the other children.
inline int sortChildren(const BoxNode& node, const Float4& bounds, double limit, std::array<DescentEntry, 4>& children,
                        double& beyond) noexcept {
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    const float bound = bounds[i];
    if (!(static_cast<double>(bound) <= limit)) {
      beyond = std::min(beyond, static_cast<double>(bound));
      continue;
    }
    if (!(bound < std::numeric_limits<float>::infinity())) continue;  // an unused place
    int at = count++;
    for (; at > 0 && children[static_cast<std::size_t>(at - 1)].bound < bound; --at)
      children[static_cast<std::size_t>(at)] = children[static_cast<std::size_t>(at - 1)];
    children[static_cast<std::size_t>(at)] = {bound, node.child[static_cast<std::size_t>(i)],
                                              node.row[static_cast<std::size_t>(i)]};
  }
  return count;
}

/// Returns the greatest float that is not above `limit`. So a float is within the one exactly if it is within the
/// other.
inline float roundedDown(double limit) noexcept {
  const auto rounded = static_cast<float>(limit);
  const std::int32_t above = static_cast<double>(rounded) > limit ? 1 : 0;
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(rounded) - above);
}

/// As sortChildren(), without branches: quicker where a processor cannot predict them, as on meshes, and slower where
/// it can. It writes all four children; those behind the returned number mean nothing. @param limit [m^2] not below 0
inline int sortChildrenAtOnce(const BoxNode& node, const Float4& bounds, double limit,
                              std::array<DescentEntry, 4>& children, double& beyond) noexcept {
  // an unused place is infinitely far, and so within an infinite limit
  const Test4 within = (bounds <= Float4{} + roundedDown(limit)) & (bounds < kEndless4);
  beyond = std::min(beyond, static_cast<double>(leastOf(within ? kEndless4 : bounds)));
  // The place of a child is the number of children that come before it.
  const Float4 keys = within ? bounds : Float4{} - 1;
  const Float4 next = __builtin_shufflevector(keys, keys, 1, 2, 3, 0),
               second = __builtin_shufflevector(keys, keys, 2, 3, 0, 1),
               third = __builtin_shufflevector(keys, keys, 3, 0, 1, 2);
  const Test4 places = -((next > keys) + (second > keys) + (third > keys) + ((next == keys) & Test4{0, 0, 0, -1}) +
                         ((second == keys) & Test4{0, 0, -1, -1}) + ((third == keys) & Test4{0, -1, -1, -1}));
  for (std::size_t i = 0; i < 4; ++i)
    children[static_cast<std::size_t>(places[i])] = {bounds[i], node.child[i], node.row[i]};
  return countOf(within);
}

}  // namespace hapticd::brep
