// SPDX-License-Identifier: MIT
#include "kernels/trace/model.hpp"

#include <algorithm>
#include <stdexcept>

#include "kernels/spline/refinement.hpp"
#include "kernels/trace/parts.hpp"
#include "kernels/trace/sewing.hpp"

namespace hapticd::trace {

Model::Model(const std::vector<spline::SurfaceData>& surfaces, const ModelOptions& options) {
  if (surfaces.empty()) throw std::invalid_argument("model: there are no surfaces, expected at least one");
  const std::vector<SidePieces> sides = split(surfaces, options.form);
  tree_.build();
  bounds_ = tree_.bounds();
  constexpr double kMostCoordinate = 1e60;  // [m] products of four larger lengths overflow
  if (!(bounds_.min().cwiseAbs().maxCoeff() <= kMostCoordinate &&
        bounds_.max().cwiseAbs().maxCoeff() <= kMostCoordinate))
    throw std::invalid_argument("model: a coordinate is beyond 1e60 m, expected smaller coordinates");
  Sewing(*this, options).run();
  free_sides_.keep(patches_, shellCount(), sides);
  bool complete = true;
  part_ = groupShells(*this, complete);
  if (!complete)
    warnings_.push_back("model: too many shells overlap, so the probe may feel surfaces that lie inside other shells");
  for (const Patch& piece : patches_) patch_part_.push_back(part_[static_cast<std::size_t>(piece.shell)]);
  part_count_ = 1 + *std::max_element(part_.begin(), part_.end());
}

std::vector<SidePieces> Model::split(const std::vector<spline::SurfaceData>& surfaces, spline::Form form) {
  std::vector<SidePieces> sides;
  has_area_ = !std::all_of(surfaces.begin(), surfaces.end(), spline::hasNoArea);
  first_patch_.reserve(surfaces.size() + 1);
  patches_.reserve(surfaces.size());
  for (std::size_t source = 0; source < surfaces.size(); ++source) {
    first_patch_.push_back(patchCount());
    const std::string& name = surfaces[source].name;
    names_.push_back(name.empty() ? "surface " + std::to_string(source) : "surface '" + name + "'");
    // A point or a line has no inside. Inside of the others it must not be the nearest.
    if (has_area_ && spline::hasNoArea(surfaces[source])) continue;
    for (const spline::SurfaceData& part : spline::splitAtCreases(surfaces[source])) {
      Patch patch;
      patch.surface = spline::Surface(part, form);
      for (int axis = 0; axis < 2; ++axis) {
        patch.lo[axis] = part.domain(axis)[0];
        patch.hi[axis] = part.domain(axis)[1];
      }
      patch.low = patch.high = part.points.front();
      for (const Eigen::Vector3d& point : part.points) {
        patch.low = patch.low.min(point.array());
        patch.high = patch.high.max(point.array());
      }
      patch.sign = surfaces[source].reversed ? -1 : 1;
      patch.source = static_cast<int>(source);
      tree_.add(part, patchCount());
      sides.push_back(piecesOfSides(part));
      patches_.push_back(std::move(patch));
    }
  }
  first_patch_.push_back(patchCount());
  return sides;
}

std::size_t Model::bytes() const noexcept {
  std::size_t bytes = tree_.bytes() + free_sides_.bytes() + patches_.capacity() * sizeof(Patch) +
                      poles_.capacity() * sizeof(PoleFan) + vertex_normal_.capacity() * sizeof(Eigen::Vector3d);
  for (const Patch& patch : patches_) bytes += patch.surface.bytes();
  return bytes;
}

}  // namespace hapticd::trace
