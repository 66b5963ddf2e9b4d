// SPDX-License-Identifier: MIT
/// How a search goes down a tree of boxes: nearest children first. It records the least bound of the boxes that it
/// leaves out.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "kernels/brep/box_tree.hpp"
#include "kernels/brep/model.hpp"

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

/// Returns true if a row of triangles or an element is farther than `limit` by its own shape. `bound` is raised to the
/// bound of this shape; if that is farther, `beyond` is lowered to it.
template <class Shape>
inline bool isFarther(const Shape& shape, const BoxProbe& probe, double limit, double& bound, double& beyond) noexcept {
  bound = std::max(bound, static_cast<double>(rowDistance(shape, probe)));
  if (!(bound > limit)) return false;
  beyond = std::min(beyond, bound);
  return true;
}

}  // namespace hapticd::brep
