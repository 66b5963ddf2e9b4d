// SPDX-License-Identifier: MIT
/// How a search goes down a tree of boxes: nearest children first, and what is left out is counted by its bound.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "kernels/brep/box_tree.hpp"
#include "kernels/brep/model.hpp"

namespace hapticd::brep {

/// A box that is still to be looked into.
struct DescentEntry {
  float bound;  ///< [m^2] nothing in it is nearer
  std::int32_t child, row;
};

/// Sorts the four children of a node by their bounds, farthest first. Returns how many are within `limit`; `beyond`
/// falls to the least bound of the others.
inline int sortChildren(const BoxNode& node, const Float4& bounds, double limit, std::array<DescentEntry, 4>& children,
                        double& beyond) noexcept {
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    const float bound = bounds[i];
    if (!(static_cast<double>(bound) <= limit)) {
      beyond = std::min(beyond, static_cast<double>(bound));
      continue;
    }
    if (!(bound < std::numeric_limits<float>::infinity())) continue;  // an empty place
    int at = count++;
    for (; at > 0 && children[static_cast<std::size_t>(at - 1)].bound < bound; --at)
      children[static_cast<std::size_t>(at)] = children[static_cast<std::size_t>(at - 1)];
    children[static_cast<std::size_t>(at)] = {bound, node.child[static_cast<std::size_t>(i)],
                                              node.row[static_cast<std::size_t>(i)]};
  }
  return count;
}

/// Whether the box of a row is farther than `limit`; then `beyond` falls to its bound. Else `bound` grows to it.
inline bool rowIsFarther(const BodyTree& body, std::int32_t row, const BoxProbe& probe, double limit, double& bound,
                         double& beyond) noexcept {
  const auto at = static_cast<std::size_t>(row);
  const float row_bound = body.slabs.empty() ? rowDistance(body.rows[at], probe) : rowDistance(body.slabs[at], probe);
  bound = std::max(bound, static_cast<double>(row_bound));
  if (!(bound > limit)) return false;
  beyond = std::min(beyond, bound);
  return true;
}

}  // namespace hapticd::brep
