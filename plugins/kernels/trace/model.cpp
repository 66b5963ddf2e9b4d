#include "kernels/trace/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernels/spline/refinement.hpp"
#include "kernels/trace/newton.hpp"
#include "kernels/trace/sewing.hpp"

namespace hapticd::trace {

Model::Model(const std::vector<spline::SurfaceData>& surfaces, const ModelOptions& options) {
  if (surfaces.empty()) throw std::invalid_argument("model: no surfaces, expected at least one");
  split(surfaces);
  tree_.build();
  bounds_ = tree_.bounds();
  Sewing(*this, options).run();
}

void Model::split(const std::vector<spline::SurfaceData>& surfaces) {
  first_patch_.reserve(surfaces.size() + 1);
  patches_.reserve(surfaces.size());
  for (std::size_t source = 0; source < surfaces.size(); ++source) {
    first_patch_.push_back(patchCount());
    const std::string& name = surfaces[source].name;
    names_.push_back(name.empty() ? "surface " + std::to_string(source) : "surface '" + name + "'");
    for (const spline::SurfaceData& part : spline::splitAtCreases(surfaces[source])) {
      Patch patch;
      patch.surface = spline::Surface(part);
      for (int axis = 0; axis < 2; ++axis) {
        patch.lo[axis] = part.domain(axis)[0];
        patch.hi[axis] = part.domain(axis)[1];
      }
      patch.sign = surfaces[source].reversed ? -1 : 1;
      patch.source = static_cast<int>(source);
      tree_.add(part, patchCount());
      patches_.push_back(std::move(patch));
    }
  }
  first_patch_.push_back(patchCount());
}

std::int64_t Model::nearby(const Eigen::Vector3d& p, double radius, Near* out, std::size_t cap) const {
  if (!p.allFinite() || !(radius >= 0)) return 0;
  constexpr double kSearchTolerance = 1e-12;  // [m]
  constexpr int kSearchEvaluations = 40;
  // [m] A surface farther than the nearest by more than this cannot become the nearest before the next search (10 ms at
  // 2 m/s): a lower bound of its distance will do, and most of the work falls away.
  constexpr double kSoon = 0.02;
  std::vector<LeafHit> hits;
  tree_.within(p, radius, hits);
  std::vector<Near> best;
  std::vector<int> slot(first_patch_.size(), -1);
  double nearest = std::numeric_limits<double>::infinity();
  for (const LeafHit& hit : hits) {
    const Leaf& leaf = tree_.leaf(hit.leaf);
    const Patch& piece = patch(leaf.patch);
    int& at = slot[static_cast<std::size_t>(piece.source)];
    if (at >= 0 &&
        hit.distance2 >= best[static_cast<std::size_t>(at)].distance * best[static_cast<std::size_t>(at)].distance)
      continue;
    if (const double bound = std::sqrt(hit.distance2); bound > nearest + kSoon) {
      if (at < 0) {
        at = static_cast<int>(best.size());
        best.push_back({piece.source, leaf.middle[0], leaf.middle[1], bound});
      } else {
        best[static_cast<std::size_t>(at)].distance = bound;
      }
      continue;
    }
    Iterate iterate;
    iterate.uv = leaf.middle;
    const LocalFoot foot = newtonFoot(piece, p, iterate, kSearchTolerance, kSearchEvaluations);
    if (at < 0) {
      at = static_cast<int>(best.size());
      best.push_back({piece.source, 0, 0, std::numeric_limits<double>::infinity()});
    }
    Near& near = best[static_cast<std::size_t>(at)];
    if (foot.distance < near.distance) near = {piece.source, foot.uv[0], foot.uv[1], foot.distance};
    nearest = std::min(nearest, near.distance);
  }
  std::erase_if(best, [radius](const Near& near) { return !(near.distance <= radius); });
  std::sort(best.begin(), best.end(), [](const Near& a, const Near& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.surface < b.surface;
  });
  if (out != nullptr) std::copy_n(best.begin(), std::min(cap, best.size()), out);
  return static_cast<std::int64_t>(best.size());
}

std::size_t Model::bytes() const noexcept {
  std::size_t bytes = tree_.bytes() + patches_.capacity() * sizeof(Patch) + poles_.capacity() * sizeof(PoleFan) +
                      vertex_normal_.capacity() * sizeof(Eigen::Vector3d);
  for (const Patch& patch : patches_) bytes += patch.surface.bytes();
  return bytes;
}

}  // namespace hapticd::trace
