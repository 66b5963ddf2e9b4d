// SPDX-License-Identifier: MIT
#include "kernels/brep/search/near_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::brep {

using Eigen::Vector3d;

int NearPlaces::rows() const noexcept {
  int rows = 0;
  for (int i = 0; i < count_; ++i) rows += places_[static_cast<std::size_t>(i)].elements.rows();
  return rows;
}

/// Collects the elements of one placement. Distances are equal in the body's frame and in the model's.
bool NearPlaces::add(const Model& model, std::uint32_t place, const Vector3d& p, double reach) noexcept {
  const Placement& at = model.placements()[place];
  const BodyTree& body = model.body(at.body);
  if (body.tree.empty()) return true;
  if (count_ == kMostPlaces || !body.discs.empty()) return false;
  Near& near = places_[static_cast<std::size_t>(count_)];
  near.place = place;
  const Vector3d p_body = at.toBody(p);
  if (!near.elements.gather(body, p_body, reach)) return false;
  beyond_ = std::min(beyond_, near.elements.beyond(p_body));
  if (near.elements.rows() > 0) ++count_;
  return true;
}

/// Adds the placements within reach. `beyond2` is lowered to the least bound of all other placements.
bool NearPlaces::collect(const Model& model, const Vector3d& p, double reach2, double& beyond2) noexcept {
  const BoxTree& tree = model.placementTree();
  const BoxProbe probe(tree, p);
  std::array<std::int32_t, BoxTree::kMaxStack> stack;
  int depth = 0, nodes = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  while (depth > 0) {
    if (++nodes > Limits::kMostNodes) return false;
    const BoxNode& node = tree.node(stack[static_cast<std::size_t>(--depth)]);
    const Float4 bounds = boxDistances(node, probe);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto bound = static_cast<double>(bounds[i]);
      if (!(bound <= reach2)) {
        beyond2 = std::min(beyond2, bound);
      } else if (node.child[i] >= 0) {
        stack[static_cast<std::size_t>(depth++)] = node.child[i];
      } else {
        const ElementRow row = BoxTree::rowOf(node.child[i]);
        for (std::uint32_t k = row.first; k < row.first + row.count; ++k)
          if (!add(model, tree.order()[k], p, std::sqrt(reach2))) return false;
      }
    }
  }
  return true;
}

bool NearPlaces::gather(const Model& model, const Vector3d& p, double reach) noexcept {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const double reach2 = reach * reach;
  double beyond2 = kEndless;
  count_ = 0;
  center_ = p;
  beyond_ = kEndless;
  if (!(reach2 < kEndless) || model.placementTree().empty() || !collect(model, p, reach2, beyond2)) {
    forget();
    return false;
  }
  beyond_ = std::min(beyond_, std::sqrt(beyond2));
  return true;
}

}  // namespace hapticd::brep
