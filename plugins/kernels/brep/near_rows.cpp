// SPDX-License-Identifier: MIT
#include "kernels/brep/near_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::brep {
template <class Choice>
void NearRows<Choice>::add(const Shape& shape, std::int32_t child) noexcept {
  const int lane = rows_ % 4;
  const auto at = static_cast<std::size_t>(rows_ / 4);
  if (lane == 0) fours_[at] = emptyFour(shape);
  put(shape, lane, fours_[at]);
  known_[at][lane] = 0;
  children_[static_cast<std::size_t>(rows_++)] = child;
}

/// Collects the rows within reach as candidates. `beyond2` is lowered to the least bound of all other rows.
template <class Choice>
bool NearRows<Choice>::collect(const BodyTree& body, const Eigen::Vector3d& p, double reach2,
                               double& beyond2) noexcept {
  const BoxProbe probe(body.tree, p);
  std::array<std::int32_t, BoxTree::kMaxStack> stack;
  int depth = 0, nodes = 0;
  candidate_count_ = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  while (depth > 0) {
    if (++nodes > Limits::kMostNodes) return false;
    const BoxNode& node = body.tree.node(stack[static_cast<std::size_t>(--depth)]);
    const Float4 bounds = boxDistances(node, probe);
    for (std::size_t i = 0; i < 4; ++i) {
      auto bound = static_cast<double>(bounds[i]);
      const std::int32_t child = node.child[i];
      if (bound <= reach2 && child >= 0) {
        stack[static_cast<std::size_t>(depth++)] = child;
        body.fetchAhead(child, 0);
        continue;
      }
      if (bound <= reach2) {
        bound = std::max(bound, static_cast<double>(rowDistance(
                                    body.template shapes<Shape>()[static_cast<std::size_t>(node.row[i])], probe)));
        if (bound <= reach2) {
          if (candidate_count_ == Limits::kMostCandidates) return false;
          candidates_[static_cast<std::size_t>(candidate_count_++)] = {static_cast<float>(bound), node.row[i], child};
          continue;
        }
      }
      beyond2 = std::min(beyond2, bound);
    }
  }
  return true;
}

template <class Choice>
bool NearRows<Choice>::gather(const BodyTree& body, const Eigen::Vector3d& p, double reach) noexcept {
  const double reach2 = reach * reach;
  double beyond2 = std::numeric_limits<double>::infinity();
  rows_ = 0;
  center_ = p;
  beyond_ = -1;
  moved_ = 0;
  if (!(reach2 < beyond2) || !collect(body, p, reach2, beyond2)) return false;
  const auto begin = candidates_.begin(), end = begin + candidate_count_;
  auto last = end;
  if (candidate_count_ > kMostRows) {
    last = begin + kMostRows;
    std::nth_element(begin, last, end, [](const Candidate& a, const Candidate& b) {
      return a.bound2 < b.bound2 || (a.bound2 == b.bound2 && a.row < b.row);
    });
    beyond2 = std::min(beyond2, static_cast<double>(last->bound2) * (1 - 1e-7));
  }
  for (auto at = begin; at != last; ++at)
    add(body.template shapes<Shape>()[static_cast<std::size_t>(at->row)], at->child);
  beyond_ = std::sqrt(beyond2);
  return true;
}

template class NearRows<ElementLimits>;
template class NearRows<TriangleLimits>;

}  // namespace hapticd::brep
