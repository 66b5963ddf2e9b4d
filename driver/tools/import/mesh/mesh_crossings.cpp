// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_crossings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace hapticd::importing {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

constexpr double kNothing = 1e-9;  ///< share of a triangle's size; a corner nearer to its plane counts as on the plane

/// Returns where the line from a to b passes through a triangle. A line that ends on the plane of the triangle only
/// touches it, so nothing is returned.
std::optional<Vector3d> pierces(const Vector3d& a, const Vector3d& b, const Triangle& t) {
  const Vector3d u = t[1] - t[0], v = t[2] - t[0], n = u.cross(v);
  const double size = std::max(u.norm(), v.norm()), least = kNothing * size * n.norm();
  const double from = n.dot(a - t[0]), to = n.dot(b - t[0]);
  if (std::abs(from) <= least || std::abs(to) <= least || (from > 0) == (to > 0)) return std::nullopt;
  const Vector3d p = a + (b - a) * (from / (from - to));
  for (std::size_t k = 0; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(n) < -kNothing * n.squaredNorm()) return std::nullopt;
  return p;
}

std::optional<Vector3d> cross(const Triangle& a, const Triangle& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (const auto p = pierces(a[k], a[(k + 1) % 3], b)) return p;
    if (const auto p = pierces(b[k], b[(k + 1) % 3], a)) return p;
  }
  return std::nullopt;
}

class Sweep {
 public:
  Sweep(const std::vector<Vector3d>& points, const std::vector<std::array<std::uint32_t, 3>>& corners,
        const std::vector<std::uint32_t>& shell, std::size_t shells)
      : points_(points), corners_(corners), shell_(shell), boxes_(shells) {
    for (std::size_t t = 0; t < corners.size(); ++t) boxes_[shell[t]].extend(boxOf(t));
  }

  /// Sorts the triangles along x, and tries each with the triangles that begin before it ends in x.
  Crossings run() {
    constexpr std::size_t kMost = 200'000'000;  // [pairs of boxes] so many take some seconds
    constexpr std::size_t kTriangles = 50;      // [pairs of boxes] one pair of triangles takes no longer
    take();
    Crossings found;
    std::size_t tried = 0;
    for (std::size_t i = 0; i < taken_.size(); ++i)
      for (std::size_t k = i + 1; k < taken_.size() && taken_[k].box.min().x() <= taken_[i].box.max().x(); ++k) {
        if (++tried > kMost) return found.all_tried = false, found;
        if (shell_[taken_[i].index] == shell_[taken_[k].index] || !taken_[i].box.intersects(taken_[k].box)) continue;
        tried += kTriangles;
        const auto p = cross(triangle(taken_[i].index), triangle(taken_[k].index));
        if (p && found.pairs++ == 0) found.first = *p;
      }
    return found;
  }

 private:
  struct Taken {
    AlignedBox3d box;
    std::size_t index;
  };

  Triangle triangle(std::size_t t) const {
    return {points_[corners_[t][0]], points_[corners_[t][1]], points_[corners_[t][2]]};
  }
  AlignedBox3d boxOf(std::size_t t) const {
    AlignedBox3d box;
    for (const std::uint32_t corner : corners_[t]) box.extend(points_[corner]);
    return box;
  }
  /// Collects the triangles that lie in the box of another shell. This is fast, because shells are few, or small and
  /// far apart.
  void take() {
    constexpr std::size_t kFew = 64;
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      const AlignedBox3d box = boxOf(t);
      bool near = boxes_.size() > kFew;
      for (std::size_t s = 0; s < boxes_.size() && !near; ++s) near = s != shell_[t] && boxes_[s].intersects(box);
      if (near) taken_.push_back({box, t});
    }
    std::sort(taken_.begin(), taken_.end(), [](const Taken& a, const Taken& b) {
      return a.box.min().x() < b.box.min().x() || (a.box.min().x() == b.box.min().x() && a.index < b.index);
    });
  }

  const std::vector<Vector3d>& points_;
  const std::vector<std::array<std::uint32_t, 3>>& corners_;
  const std::vector<std::uint32_t>& shell_;
  std::vector<AlignedBox3d> boxes_;
  std::vector<Taken> taken_;
};

}  // namespace

Crossings crossingsOf(const std::vector<Vector3d>& points, const std::vector<std::array<std::uint32_t, 3>>& corners,
                      const std::vector<std::uint32_t>& shell, std::size_t shells) {
  return shells > 1 ? Sweep(points, corners, shell, shells).run() : Crossings{};
}

}  // namespace hapticd::importing
