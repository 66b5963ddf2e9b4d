// SPDX-License-Identifier: MIT
/// Global search over a model. It takes the leaves of the box tree that could soon have the nearest foot, nearest
/// first, and starts Newton's method from the middle of each.
#include <algorithm>
#include <cmath>

#include "kernels/trace/model.hpp"
#include "kernels/trace/newton.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

/// The state of one search.
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

  /// Examines a leaf: looks for the nearest foot of its surface, or else for another local minimum of the distance.
  /// @param bound [m] lower bound of the leaf's distance
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
    // this surface cannot become the nearest soon, so a bound is enough; this saves most of the work
    if (bound > nearest + Model::kSoon) {
      near.distance = bound;
      return;
    }
    constexpr int kEvaluations = 40;
    const LocalFoot foot = footFrom(leaf, kEvaluations);
    keepValley(leaf.patch, foot);
    if (foot.distance < near.distance) near = {source, foot.uv[0], foot.uv[1], foot.distance};
    nearest = std::min(nearest, near.distance);
  }

  /// Returns the nearest distance found so far for the part of a patch. Each part counts separately, because a tracer
  /// must know for each part whether the probe is inside.
  double& nearestOf(int patch) { return nearest_[static_cast<std::size_t>(model_.part(model_.patch(patch).shell))]; }

  LocalFoot footFrom(const Leaf& leaf, int evaluations) const {
    constexpr double kTolerance = 1e-12;  // [m]
    Iterate iterate;
    iterate.uv = leaf.middle;
    return newtonFoot(model_.patch(leaf.patch), p_, iterate, kTolerance, evaluations);
  }

  /// Looks for a local minimum of the distance (a valley) in a leaf. Newton's method starts at the middle of the leaf.
  /// If there is a minimum in this leaf, the steps stay near it; so the search is given up if the first step leads
  /// away.
  void lookForValley(const Leaf& leaf) {
    if (!leaf.mayFace(p_) && !atFreeSide(leaf)) return;
    constexpr int kFirst = 2, kEvaluations = 20;
    const double kNear = 2;  // distance from the middle of the leaf, in half widths of the leaf
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
      if (gap <= slack[axis] && piece.side(side).kind == SideKind::kFree) return true;
    }
    return false;
  }

  void keepValley(int patch, const LocalFoot& foot) {
    const Patch& piece = model_.patch(patch);
    // this foot is not a minimum if the distance still falls beyond a common side
    if (!foot.converged || piece.continuesBeyond(foot.sides)) return;
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
  std::span<const int> parts_;  ///< part of each patch
  const Vector3d p_;
  Found& found_;
  std::vector<int> slot_;  ///< for each surface, its index in found_.nearest before sorting
  std::vector<Valley> valleys_;
  double same_;                  ///< [m] feet that are closer than this are the same
  std::vector<double> nearest_;  ///< [m] nearest distance found so far, for each part
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
