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

/// Adds a shape to the candidates, if it is within reach. Returns false if there are too many.
template <class Choice>
bool NearRows<Choice>::consider(const Candidate& next, double reach2, double& beyond2) noexcept {
  const auto bound = static_cast<double>(next.bound2);
  if (!(bound <= reach2)) {
    beyond2 = std::min(beyond2, bound);
    return true;
  }
  if (candidate_count_ == Limits::kMostCandidates) return false;
  candidates_[static_cast<std::size_t>(candidate_count_++)] = next;
  return true;
}

/// Considers what is in a row of the tree: each element of a body of faces, or the disc of a row of triangles.
template <class Choice>
bool NearRows<Choice>::considerRow(const BodyTree& body, const BoxProbe& probe, const Candidate& row, double reach2,
                                   double& beyond2) noexcept {
  const auto boundOf = [&](std::int32_t shape) {
    return std::max(row.bound2, rowDistance(body.template shapes<Shape>()[static_cast<std::size_t>(shape)], probe));
  };
  if constexpr (std::is_same_v<Shape, RowDisc>)
    return consider({boundOf(row.row), row.row, row.child}, reach2, beyond2);
  const ElementRow elements = BoxTree::rowOf(row.child);
  looks_ += static_cast<int>(elements.count);
  if (looks_ > Limits::kMostLooks) return false;
  for (std::uint32_t i = elements.first; i < elements.first + elements.count; ++i) {
    const auto place = static_cast<std::int32_t>(i);
    if (!consider({boundOf(place), place, BoxTree::codeOf({i, 1})}, reach2, beyond2)) return false;
  }
  return true;
}

/// Collects the rows within reach as candidates. `beyond2` is lowered to the least bound of all other rows.
template <class Choice>
bool NearRows<Choice>::collect(const BodyTree& body, const Eigen::Vector3d& p, double reach2,
                               double& beyond2) noexcept {
  const BoxProbe probe(body.tree, p);
  std::array<std::int32_t, BoxTree::kMaxStack> stack;
  int depth = 0, nodes = 0;
  candidate_count_ = looks_ = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  while (depth > 0) {
    if (++nodes > Limits::kMostNodes) return false;
    const BoxNode& node = body.tree.node(stack[static_cast<std::size_t>(--depth)]);
    const Float4 bounds = boxDistances(node, probe);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int32_t child = node.child[i];
      if (!(static_cast<double>(bounds[i]) <= reach2)) {
        beyond2 = std::min(beyond2, static_cast<double>(bounds[i]));
      } else if (child >= 0) {
        stack[static_cast<std::size_t>(depth++)] = child;
        body.fetchAhead(child, 0);
      } else if (!considerRow(body, probe, {bounds[i], node.row[i], child}, reach2, beyond2)) {
        return false;
      }
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
