// SPDX-License-Identifier: MIT
/// Global search over a model: leaves of the box tree that may matter soon, nearest first, and Newton from the middle
/// of each.
#include <algorithm>
#include <cmath>

#include "kernels/trace/model.hpp"
#include "kernels/trace/newton.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

/// One search under way.
class Search {
 public:
  Search(const Model& model, const BoxTree& tree, std::span<const int> parts, const Vector3d& p, Found& found)
      : model_(model),
        tree_(tree),
        parts_(parts),
        p_(p),
        found_(found),
        slot_(static_cast<std::size_t>(model.surfaceCount()), -1),
        same_(1e-5 * model.bounds().diagonal().norm()),
        nearest_(static_cast<std::size_t>(model.partCount()), kInfinity) {}

  void run(double radius) {
    std::vector<LeafHit> hits;
    tree_.near(p_, radius, Model::kSoon, parts_, model_.partCount(), hits);
    for (const LeafHit& hit : hits) look(tree_.leaf(hit.leaf), std::sqrt(hit.distance2));
    std::erase_if(found_.nearest, [radius](const Near& near) { return !(near.distance <= radius); });
    std::sort(found_.nearest.begin(), found_.nearest.end(), before);
    keepRivals();
  }

 private:
  struct Valley {
    Near near;
    Vector3d point;
    int patch;
  };

  static bool before(const Near& a, const Near& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.surface < b.surface;
  }

  /// Looks at a leaf that is `bound` or more away: for the nearest foot of its surface, or else for another valley.
  void look(const Leaf& leaf, double bound) {
    const int source = model_.patch(leaf.patch).source;
    double& nearest = nearestOf(leaf.patch);
    int& at = slot_[static_cast<std::size_t>(source)];
    const bool known = at >= 0;
    if (known && bound >= found_.nearest[static_cast<std::size_t>(at)].distance) {
      if (bound <= nearest + Model::kSoon) lookForValley(leaf);
      return;
    }
    if (!known) {
      at = static_cast<int>(found_.nearest.size());
      found_.nearest.push_back({source, leaf.middle[0], leaf.middle[1], kInfinity});
    }
    Near& near = found_.nearest[static_cast<std::size_t>(at)];
    if (bound > nearest + Model::kSoon) {  // cannot become the nearest soon: a bound will do, and most work falls away
      near.distance = bound;
      return;
    }
    constexpr int kEvaluations = 40;
    const LocalFoot foot = footFrom(leaf, kEvaluations);
    keepValley(leaf.patch, foot);
    if (foot.distance < near.distance) near = {source, foot.uv[0], foot.uv[1], foot.distance};
    nearest = std::min(nearest, near.distance);
  }

  /// Distance of what was found of a patch's part: a tracer has to tell of each part whether the probe is inside.
  double& nearestOf(int patch) { return nearest_[static_cast<std::size_t>(model_.part(model_.patch(patch).shell))]; }

  LocalFoot footFrom(const Leaf& leaf, int evaluations) const {
    constexpr double kTolerance = 1e-12;  // [m]
    Iterate iterate;
    iterate.uv = leaf.middle;
    return newtonFoot(model_.patch(leaf.patch), p_, iterate, kTolerance, evaluations);
  }

  /// A valley has its bottom in some leaf, and Newton from the middle of that leaf stays near: others are given up
  /// after the first step.
  void lookForValley(const Leaf& leaf) {
    if (!leaf.mayFace(p_) && !atFreeSide(leaf)) return;
    constexpr int kFirst = 2, kEvaluations = 20;
    const double kNear = 2;  // half-widths of the leaf
    const auto strays = [&leaf, kNear](const LocalFoot& foot) {
      return ((foot.uv - leaf.middle).abs() > kNear * leaf.half).any();
    };
    const LocalFoot first = footFrom(leaf, kFirst);
    if (strays(first)) return;
    keepValley(leaf.patch, first.converged ? first : footFrom(leaf, kEvaluations));
  }

  bool atFreeSide(const Leaf& leaf) const {
    const Patch& piece = model_.patch(leaf.patch);
    const Eigen::Array2d slack = 1e-9 * (piece.hi - piece.lo);
    for (int side = 0; side < kSides; ++side) {
      const int axis = Patch::axisOf(side);
      const double gap = side % 2 == 0 ? leaf.middle[axis] - leaf.half[axis] - piece.lo[axis]
                                       : piece.hi[axis] - leaf.middle[axis] - leaf.half[axis];
      if (gap <= slack[axis] && piece.sides[static_cast<std::size_t>(side)].kind == SideKind::kFree) return true;
    }
    return false;
  }

  void keepValley(int patch, const LocalFoot& foot) {
    const Patch& piece = model_.patch(patch);
    if (!foot.converged || piece.goesOn(foot.sides)) return;  // beyond a common side it goes on down
    for (const Valley& valley : valleys_)
      if (valley.near.surface == piece.source && (valley.point - foot.S).norm() < same_) return;
    valleys_.push_back({{piece.source, foot.uv[0], foot.uv[1], foot.distance}, foot.S, patch});
  }

  void keepRivals() {
    constexpr std::size_t kMostRivals = 16;
    for (const Valley& valley : valleys_) {
      const int at = slot_[static_cast<std::size_t>(valley.near.surface)];
      if (at < 0 || valley.near.distance > nearestOf(valley.patch) + Model::kSoon) continue;
      const auto first = std::find_if(found_.nearest.begin(), found_.nearest.end(),
                                      [&](const Near& near) { return near.surface == valley.near.surface; });
      if (first != found_.nearest.end() && (first->u != valley.near.u || first->v != valley.near.v))
        found_.rivals.push_back(valley.near);
    }
    std::sort(found_.rivals.begin(), found_.rivals.end(), before);
    if (found_.rivals.size() > kMostRivals) found_.rivals.resize(kMostRivals);
  }

  const Model& model_;
  const BoxTree& tree_;
  std::span<const int> parts_;  ///< by patch
  const Vector3d p_;
  Found& found_;
  std::vector<int> slot_;  ///< by surface: index in found_.nearest before it is sorted
  std::vector<Valley> valleys_;
  double same_;                  ///< [m] feet closer than this are one
  std::vector<double> nearest_;  ///< [m] by part
};

}  // namespace

void Model::search(const Vector3d& p, double radius, Found& found) const {
  found.nearest.clear();
  found.rivals.clear();
  if (p.allFinite() && radius >= 0) Search(*this, tree_, patch_part_, p, found).run(radius);
}

std::int64_t Model::nearby(const Vector3d& p, double radius, Near* out, std::size_t cap) const {
  Found found;
  search(p, radius, found);
  if (out != nullptr) std::copy_n(found.nearest.begin(), std::min(cap, found.nearest.size()), out);
  return static_cast<std::int64_t>(found.nearest.size());
}

}  // namespace hapticd::trace
