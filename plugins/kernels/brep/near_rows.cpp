// SPDX-License-Identifier: MIT
#include "kernels/brep/near_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::brep {
namespace {

constexpr int kMostNodes = 128;  ///< of the tree, looked at in one gathering

FourSlabs nothing() noexcept {
  constexpr float kFar = 1e18F;  // its square is a float
  FourSlabs slabs{};
  slabs.center[0] = Float4{kFar, kFar, kFar, kFar};
  return slabs;
}

}  // namespace

void NearRows::add(const RowSlab& slab, std::int32_t child) noexcept {
  const int lane = rows_ % 4;
  FourSlabs& to = fours_[static_cast<std::size_t>(rows_ / 4)];
  if (lane == 0) to = nothing();
  for (int axis = 0; axis < 3; ++axis) {
    to.center[axis][lane] = slab.center[axis];
    to.normal[axis][lane] = slab.normal[axis];
  }
  to.half[lane] = slab.half;
  to.radius[lane] = slab.radius;
  children_[static_cast<std::size_t>(rows_++)] = child;
}

bool NearRows::gather(const BodyTree& body, const Eigen::Vector3d& p, double reach) noexcept {
  const double reach2 = reach * reach;
  double beyond2 = std::numeric_limits<double>::infinity();
  const BoxProbe probe(body.tree, p);
  std::array<std::int32_t, BoxTree::kMaxStack> stack;
  int depth = 0, nodes = 0;
  rows_ = 0;
  center_ = p;
  beyond_ = -1;
  if (!(reach2 < beyond2)) return false;
  stack[static_cast<std::size_t>(depth++)] = 0;
  while (depth > 0) {
    if (++nodes > kMostNodes) return false;
    const BoxNode& node = body.tree.node(stack[static_cast<std::size_t>(--depth)]);
    const Float4 bounds = boxDistances(node, probe);
    for (std::size_t i = 0; i < 4; ++i) {
      auto bound = static_cast<double>(bounds[i]);
      const std::int32_t child = node.child[i];
      if (bound <= reach2 && child >= 0) {
        stack[static_cast<std::size_t>(depth++)] = child;
        continue;
      }
      if (bound <= reach2) {
        const RowSlab& slab = body.slabs[static_cast<std::size_t>(node.row[i])];
        bound = std::max(bound, static_cast<double>(slabDistance(slab, probe)));
        if (bound <= reach2) {
          if (rows_ == 4 * kMostFours) return false;
          add(slab, child);
          continue;
        }
      }
      beyond2 = std::min(beyond2, bound);
    }
  }
  beyond_ = std::sqrt(beyond2);
  return true;
}

}  // namespace hapticd::brep
