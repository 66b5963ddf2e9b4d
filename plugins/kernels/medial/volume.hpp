// SPDX-License-Identifier: MIT
/// Keeps the volume of a pressed body: if a contact pushes a part in, the rest of the surface moves out.
#pragma once
#include <algorithm>
#include <vector>

#include "kernels/medial/moving_mesh.hpp"
#include "kernels/medial/nodes.hpp"

namespace hapticd::medial {

/// Grows all radii by the same length, the bulge, until the body has its volume at rest again. The volume is the exact
/// integral over the triangles of the displaced contour. Each tick adds a bounded number of triangles to this sum. When
/// the sum is complete, the bulge makes one Newton step. The bulge does no work on the displacements of the nodes, so
/// the energy of the nodes falls as it would without a bulge.
class VolumeKeeper {
 public:
  /// [main] Allocates all memory.
  VolumeKeeper(const MovingMesh& contour, double greatest_radius)
      : contour_(&contour), xyz_(contour.atRest()), limit_(kMostBulge * greatest_radius) {
    rest_ = contour.volume(xyz_);
    area_ = contour.area(xyz_);
  }

  /// [rt] Adds the next triangles to the sum, and sets the bulge of `nodes` when the sum is complete. Returns at once
  /// while the body is at rest.
  void step(Nodes& nodes) noexcept {
    if (nodes.awake() == 0 && nodes.bulge() == 0 && next_vertex_ == 0) return;
    for (std::size_t work = 0; work < kWork;) {
      const std::size_t vertices = contour_->vertexCount(), triangles = contour_->indices().size() / 3;
      if (next_vertex_ < vertices) {
        const std::size_t part = std::min(kWork - work, vertices - next_vertex_);
        contour_->write([&nodes](std::size_t i) -> Eigen::Vector4f { return nodes.displacement(i).cast<float>(); },
                        xyz_.data() + 3 * next_vertex_, part, static_cast<float>(nodes.bulge()), next_vertex_);
        next_vertex_ += part;
        work += part;
      } else if (next_triangle_ < triangles) {
        const std::size_t part = std::min(kWork - work, triangles - next_triangle_);
        sum_ += contour_->sixVolumes(xyz_.data(), next_triangle_, next_triangle_ + part);
        next_triangle_ += part;
        work += part;
      } else {
        return correct(nodes);
      }
    }
  }
  /// [rt] Starts the sum again. Call it after all nodes were put back to rest.
  void reset() noexcept {
    next_vertex_ = next_triangle_ = 0;
    sum_ = 0;
  }
  std::size_t bytes() const noexcept { return sizeof *this + xyz_.capacity() * sizeof(float); }

 private:
  static constexpr std::size_t kWork = 1024;  ///< most vertices and triangles per tick
  static constexpr double kMostBulge = 0.5;   ///< greatest bulge, as a share of the greatest radius
  static constexpr double kStill = 1e-7;      ///< [m] once the body is at rest, a smaller bulge is set to 0

  void correct(Nodes& nodes) noexcept {
    const double step = area_ > 0 ? (rest_ - sum_ / 6) / area_ : 0;
    double bulge = std::clamp(nodes.bulge() + step, -limit_, limit_);
    if (!(bulge == bulge) || (nodes.awake() == 0 && bulge < kStill && bulge > -kStill)) bulge = 0;
    nodes.setBulge(bulge);
    reset();
  }

  const MovingMesh* contour_;
  std::vector<float> xyz_;
  double rest_ = 0, area_ = 0;  ///< [m^3] volume and [m^2] surface of the body at rest
  double limit_ = 0, sum_ = 0;
  std::size_t next_vertex_ = 0, next_triangle_ = 0;
};

}  // namespace hapticd::medial
