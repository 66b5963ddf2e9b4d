// SPDX-License-Identifier: MIT
/// The search of whole trees of boxes, for a probe about which nothing is gathered.
#include <algorithm>
#include <array>
#include <cstdint>

#include "kernels/brep/search/search.hpp"

namespace hapticd::brep {

using Eigen::Vector3d;

namespace {

/// True if a search must end. Where nothing was found yet, it goes on for longer: without any foot, the part would not
/// be felt at all. So does the search of a mesh: the foot on a triangle takes a tenth of the time of one on a spline,
/// and at the hub of a fan, such as the tip of a cone, all its triangles are equally near.
bool isSpent(const Nearest& best, const SearchBudget& budget, bool mesh) noexcept {
  constexpr std::int64_t kMore = 8, kTriangles = 4;
  const std::int64_t times = best.found() ? 1 : kMore, elements = mesh ? kTriangles : 1;
  return best.nodes >= times * budget.nodes || best.elements >= times * elements * budget.elements;
}

}  // namespace

/// Examines a row of triangles, if its disc is near enough.
void Search::examineTriangles(const Descent& at, const DescentEntry& entry, Run& run) noexcept {
  const RowDisc& disc = at.body.discs[static_cast<std::size_t>(entry.row)];
  const auto bound = static_cast<double>(std::max(entry.bound, rowDistance(disc, at.probe)));
  if (bound > run.within2()) {
    run.others2 = std::min(run.others2, bound);
    return;
  }
  const ElementRow row = BoxTree::rowOf(entry.child);
  for (std::uint32_t i = row.first; i < row.first + row.count; ++i)
    if (const Element element = at.body.elements[i]; !(element == at.first))
      examineTriangle(at.place, element, at.p, run);
}

/// Measures the boxes of the elements of a row, four at once. @param take called with the place of each element and the
/// lower bound of its squared distance [m^2]
template <class Take>
void Search::measureElements(const Descent& at, const ElementRow& row, const Take& take) noexcept {
  const std::uint32_t end = row.first + row.count;
  const auto placeOf = [&](std::uint32_t i) { return at.of_face != nullptr ? at.of_face[i] : i; };
  const auto box = [&](std::uint32_t i) -> const RowBox& { return at.body.rows[placeOf(std::min(i, end - 1))]; };
  if (row.count == 1) return take(placeOf(row.first), rowDistance(box(row.first), at.probe));
  for (std::uint32_t i = row.first; i < end; i += 4) {
    const Float4 bounds = rowDistances(fourOf(box(i), box(i + 1), box(i + 2), box(i + 3)), at.probe);
    for (std::uint32_t k = 0; k < 4 && i + k < end; ++k) take(placeOf(i + k), bounds[static_cast<int>(k)]);
  }
}

/// Examines those elements of a row whose own boxes are near enough, the nearest box first.
void Search::examineElements(const Descent& at, const DescentEntry& entry, Run& run) noexcept {
  struct Candidate {
    double bound;
    std::uint32_t place;
  };
  std::array<Candidate, BoxTree::kMaxRow> near;
  std::size_t count = 0;
  measureElements(at, BoxTree::rowOf(entry.child), [&](std::uint32_t place, float own) {
    const auto bound = static_cast<double>(std::max(entry.bound, own));
    if (bound > run.within2()) {
      run.others2 = std::min(run.others2, bound);
      return;
    }
    std::size_t k = count++;
    for (; k > 0 && near[k - 1].bound > bound; --k) near[k] = near[k - 1];
    near[k] = {bound, place};
  });
  for (std::size_t k = 0; k < count; ++k) {
    const auto [bound, place] = near[k];
    const Element element = at.body.elements[place];
    if (bound > run.within2())
      run.others2 = std::min(run.others2, bound);
    else if (!(element == at.first))
      examine(at.place, element, at.p, bound, run);
  }
}

void Search::searchTree(const BodyTree& body, std::int32_t root, std::uint32_t place, const Vector3d& p,
                        Run& run) noexcept {
  if (body.tree.empty() || root == BodyTree::kNoRoot) return;
  Nearest& best = run.best;
  const Element first = run.first_place == place ? run.first : Element();  // begin() has examined this element
  const Descent at{body, root > 0 ? body.of_faces.data() : nullptr, place, p, first, BoxProbe(body.tree, p)};
  std::array<DescentEntry, BoxTree::kMaxStack> stack;
  std::array<DescentEntry, 4> children;
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = {0, root, 0};
  while (depth > 0) {
    const DescentEntry entry = stack[static_cast<std::size_t>(--depth)];
    const auto bound = static_cast<double>(entry.bound);
    if (bound > run.within2()) {
      run.others2 = std::min(run.others2, bound);
      continue;
    }
    if (isSpent(best, run.budget, !body.discs.empty())) {
      best.exhausted = true;
      run.open2 = std::min(run.open2, bound);
      continue;
    }
    if (entry.child < 0) {
      if (body.discs.empty())
        ++best.nodes, examineElements(at, entry, run);  // a row has as many boxes as a node
      else
        examineTriangles(at, entry, run);
      continue;
    }
    ++best.nodes;
    const BoxNode& node = body.tree.node(entry.child);
    const Float4 bounds = boxDistances(node, at.probe);
    const int count = body.discs.empty() ? sortChildren(node, bounds, run.within2(), children, run.others2)
                                         : sortChildrenAtOnce(node, bounds, run.within2(), children, run.others2);
    for (int i = 0; i < count; ++i) {
      const DescentEntry& child = children[static_cast<std::size_t>(i)];
      stack[static_cast<std::size_t>(depth++)] = child;
      if (child.child >= 0 || at.of_face == nullptr) body.fetchAhead(child.child, child.row);
    }
  }
}

/// Searches the tree of the placements, and in it the trees of their bodies.
void Search::searchPlaces(const Vector3d& p, Run& run) noexcept {
  const BoxTree& tree = model_.placementTree();
  const BoxProbe probe(tree, p);
  std::array<DescentEntry, BoxTree::kMaxStack> stack;
  std::array<DescentEntry, 4> children;
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = {0, 0, 0};
  while (depth > 0) {
    const DescentEntry entry = stack[static_cast<std::size_t>(--depth)];
    const auto bound = static_cast<double>(entry.bound);
    if (bound > run.within2()) {
      run.others2 = std::min(run.others2, bound);
      continue;
    }
    if (entry.child < 0) {
      const ElementRow row = BoxTree::rowOf(entry.child);
      for (std::uint32_t i = row.first; i < row.first + row.count; ++i) {
        const std::uint32_t place = tree.order()[i];
        const Placement& at = model_.placements()[place];
        searchTree(model_.body(at.body), 0, place, at.toBody(p), run);
      }
      continue;
    }
    ++run.best.nodes;
    const BoxNode& node = tree.node(entry.child);
    const int count = sortChildren(node, boxDistances(node, probe), run.within2(), children, run.others2);
    for (int i = 0; i < count; ++i) stack[static_cast<std::size_t>(depth++)] = children[static_cast<std::size_t>(i)];
  }
}

}  // namespace hapticd::brep
