// SPDX-License-Identifier: MIT
#include "kernels/brep/search/near_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "kernels/brep/search/descent.hpp"

namespace hapticd::brep {
namespace {

/// Returns the number of the shape of a row of the tree: that of its disc, or of the box of its first element.
template <class Shape>
inline std::int32_t shapeOf(const BoxNode& node, std::size_t child) noexcept {
  if constexpr (std::is_same_v<Shape, RowDisc>) return node.row[child];
  return static_cast<std::int32_t>(BoxTree::rowOf(node.child[child]).first);
}

}  // namespace

/// Adds up to four candidates to the rows, from number `first` on.
template <class Choice>
void NearRows<Choice>::add(const BodyTree& body, int first) noexcept {
  const auto& shapes = body.template shapes<Shape>();
  const auto at = static_cast<std::size_t>(first / 4);
  const int last = std::min(first + 4, rows_) - 1;
  const auto shape = [&](int lane) -> const Shape& {
    return shapes[static_cast<std::size_t>(candidates_[static_cast<std::size_t>(std::min(first + lane, last))].row)];
  };
  for (int i = first; i <= last; ++i)
    children_[static_cast<std::size_t>(i)] = candidates_[static_cast<std::size_t>(i)].child;
  known_[at] = Float4{};
  fours_[at] = fourOf(shape(0), shape(1), shape(2), shape(3));
  for (int lane = last - first + 1; lane < 4; ++lane) putNothing(lane, fours_[at]);
}

/// Adds the listed shapes that are within reach to the candidates, four at once. Returns false if there are too many.
template <class Choice>
bool NearRows<Choice>::considerListed(const BodyTree& body, const BoxProbe& probe, double reach2,
                                      double& beyond2) noexcept {
  const Float4 limit = Float4{} + roundedDown(reach2);
  Float4 beyond = kEndless4;
  const std::vector<Shape>& shapes = body.template shapes<Shape>();
  const int count = listed_count_;
  for (int r = 0; r < count; ++r) {
    const Candidate& row = listed_[static_cast<std::size_t>(r)];
    __builtin_prefetch(&shapes[static_cast<std::size_t>(row.row)]);
    __builtin_prefetch(&body.elements[BoxTree::rowOf(row.child).first]);
  }
  for (int r = 0; r < count; r += 4) {
    if (candidate_count_ > Limits::kMostCandidates - 4) return false;
    const Candidate* const four = &listed_[static_cast<std::size_t>(r)];
    const auto shape = [&](int i) -> const Shape& {
      return shapes[static_cast<std::size_t>(four[r + i < count ? i : 0].row)];
    };
    const Float4 boxes{four[0].bound2, four[1].bound2, four[2].bound2, four[3].bound2};
    const Float4 own = rowDistances(fourOf(shape(0), shape(1), shape(2), shape(3)), probe);
    const Test4 used = Test4{0, 1, 2, 3} < Test4{} + (count - r);
    const Float4 bounds = own > boxes ? own : boxes;
    const Test4 within = (bounds <= limit) & used;
    beyond = lesser(within | ~used ? kEndless4 : bounds, beyond);
    for (int i = 0; i < 4; ++i) {
      candidates_[static_cast<std::size_t>(candidate_count_)] = {bounds[i], four[i].row, four[i].child};
      candidate_count_ -= within[i];
    }
  }
  beyond2 = std::min(beyond2, static_cast<double>(leastOf(beyond)));
  return true;
}

/// Lists the rows of the tree whose boxes are within reach. It opens several boxes before it lists what is in them: so
/// they come from memory together, and a processor need not know how long the list is to go on with the next. No branch
/// depends on a distance.
template <class Choice>
bool NearRows<Choice>::openBoxes(const BodyTree& body, const BoxProbe& probe, double reach2, double& beyond2) noexcept {
  const Float4 limit = Float4{} + roundedDown(reach2);
  constexpr int kAtOnce = Limits::kOpenAtOnce;
  Float4 beyond = kEndless4;
  std::array<std::int32_t, Limits::kMostNodes + 4 * kAtOnce> nodes;
  nodes[0] = 0;  // the root
  int count = 1, rows = 0;
  for (int next = 0; next < count;) {
    const int last = std::min(next + kAtOnce, count) - 1;
    const BoxNode* open[kAtOnce];
    Float4 bounds[kAtOnce];
    Test4 within[kAtOnce];
    for (int k = 0; k < kAtOnce; ++k)
      open[k] = &body.tree.node(nodes[static_cast<std::size_t>(std::min(next + k, last))]);
    for (int k = 0; k < kAtOnce; ++k) {
      bounds[k] = boxDistances(*open[k], probe);
      const Test4 near = bounds[k] <= limit;
      beyond = lesser(near ? kEndless4 : bounds[k], beyond);
      within[k] = near & (Test4{} + (next + k <= last ? -1 : 0));
    }
    next = last + 1;
    for (int k = 0; k < kAtOnce; ++k)
      for (std::size_t i = 0; i < 4; ++i) {
        const std::int32_t child = open[k]->child[i], is_row = child >> 31;  // -1 if it is a row
        nodes[static_cast<std::size_t>(count)] = child;
        listed_[static_cast<std::size_t>(rows)] = {bounds[k][i], shapeOf<Shape>(*open[k], i), child};
        count -= within[k][i] & ~is_row;
        rows -= within[k][i] & is_row;
      }
    if (count > Limits::kMostNodes || rows > Limits::kMostListed) return false;
    for (int k = kAtOnce; k < 2 * kAtOnce; ++k)
      body.fetchAhead(nodes[static_cast<std::size_t>(std::min(next + k, count - 1))], 0);
  }
  listed_count_ = rows;
  beyond2 = std::min(beyond2, static_cast<double>(leastOf(beyond)));
  return true;
}

/// Lists the elements of the listed rows instead of the rows. Returns false if there are too many.
template <class Choice>
bool NearRows<Choice>::listElements(const BodyTree& body) noexcept {
  if (static_cast<std::size_t>(body.tree.rowCount()) == body.elements.size()) return true;  // they are the same
  std::array<Candidate, Limits::kMostListed + 16> elements;
  int count = 0;
  for (int r = 0; r < listed_count_; ++r) {
    const Candidate& listed = listed_[static_cast<std::size_t>(r)];
    const ElementRow row = BoxTree::rowOf(listed.child);
    if (count + static_cast<int>(row.count) > Limits::kMostListed) return false;
    for (std::uint32_t i = 0; i < BodyTree::kElementRow; ++i)
      elements[static_cast<std::size_t>(count) + i] = {listed.bound2, static_cast<std::int32_t>(row.first + i),
                                                       BoxTree::codeOf({row.first + i, 1})};
    count += static_cast<int>(row.count);
  }
  std::copy(elements.begin(), elements.begin() + count, listed_.begin());
  listed_count_ = count;
  return true;
}

/// Collects the rows within reach as candidates. `beyond2` is lowered to the least bound of all other rows.
template <class Choice>
bool NearRows<Choice>::collect(const BodyTree& body, const Eigen::Vector3d& p, double reach2,
                               double& beyond2) noexcept {
  const BoxProbe probe(body.tree, p);
  candidate_count_ = 0;
  if (!openBoxes(body, probe, reach2, beyond2)) return false;
  if constexpr (std::is_same_v<Shape, RowBox>)
    if (!listElements(body)) return false;
  return considerListed(body, probe, reach2, beyond2);
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
  if (candidate_count_ > kMostRows) {
    const auto last = begin + kMostRows;
    std::nth_element(begin, last, end, [](const Candidate& a, const Candidate& b) {
      return a.bound2 < b.bound2 || (a.bound2 == b.bound2 && a.row < b.row);
    });
    beyond2 = std::min(beyond2, static_cast<double>(last->bound2) * (1 - 1e-7));
  }
  rows_ = std::min(candidate_count_, kMostRows);
  for (int i = 0; i < rows_; i += 4) add(body, i);
  beyond_ = std::sqrt(beyond2);
  return true;
}

template class NearRows<ElementLimits>;
template class NearRows<TriangleLimits>;

}  // namespace hapticd::brep
