// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_nesting.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;

class Nest {
 public:
  explicit Nest(const Shells& shells) : given_(shells), triangles_(shells.closed.size()), boxes_(shells.closed.size()) {
    found_.volume.assign(shells.closed.size(), 0);
    found_.inside_out.assign(shells.closed.size(), 0);
    for (std::uint32_t t = 0; t < shells.corners.size(); ++t) {
      const std::uint32_t s = shells.shell[t];
      triangles_[s].push_back(t);
      for (const std::uint32_t corner : shells.corners[t]) boxes_[s].extend(shells.points[corner]);
    }
    for (std::size_t s = 0; s < triangles_.size(); ++s) found_.volume[s] = volumeOf(s);
  }

  /// Goes from the largest to the smallest volume, so a shell comes after the shells around it.
  Nesting run() {
    std::vector<std::size_t> order(boxes_.size());
    std::iota(order.begin(), order.end(), 0);
    const auto size = [this](std::size_t s) { return std::abs(found_.volume[s]); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
    std::vector<std::size_t> outer;
    for (const std::size_t s : order) {
      if (given_.closed[s] == 0) continue;
      const std::size_t around = nearestAround(s, outer);
      outer.push_back(s);
      if (around == kNobody) {
        found_.inside_out[s] = found_.volume[s] < 0 ? 1 : 0;
        continue;
      }
      found_.inside_out[s] = found_.inside_out[around];
      const auto faces = [this](std::size_t i) { return (found_.volume[i] < 0) != (found_.inside_out[i] != 0); };
      found_.solids_inside += faces(s) == faces(around) ? 1 : 0;
    }
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kNobody = static_cast<std::size_t>(-1);

  /// Relative to the middle of the shell, so that nothing cancels if it is small and far from the origin.
  double volumeOf(std::size_t s) const {
    const Vector3d middle = boxes_[s].isEmpty() ? Vector3d(0, 0, 0) : Vector3d(boxes_[s].center());
    double volume = 0;
    for (const std::uint32_t t : triangles_[s]) {
      const auto& c = given_.corners[t];
      const auto at = [&](std::size_t k) -> Vector3d { return given_.points[c[k]] - middle; };
      volume += at(0).dot(at(1).cross(at(2))) / 6;
    }
    return volume;
  }

  /// Returns the smallest of the larger shells that contains a shell.
  std::size_t nearestAround(std::size_t s, const std::vector<std::size_t>& outer) {
    constexpr std::size_t kMostBoxes = 2'000'000'000;  // some seconds: all pairs of 60,000 shells
    if (boxes_tried_ > kMostBoxes) {
      found_.incomplete = true;
      return kNobody;
    }
    boxes_tried_ += outer.size();
    for (auto it = outer.rbegin(); it != outer.rend(); ++it)
      if (boxes_[*it].contains(boxes_[s]) && contains(*it, s)) return *it;
    return kNobody;
  }

  /// Counts how often a line from a corner of the inner shell goes through the outer one. If there are too many
  /// triangles to count, the boxes decide.
  bool contains(std::size_t outer, std::size_t inner) {
    constexpr std::size_t kMost = 200'000'000;  // [triangles] some seconds
    tried_ += triangles_[outer].size();
    if (tried_ > kMost) return true;
    const Vector3d from = given_.points[given_.corners[triangles_[inner].front()][0]];
    const Vector3d way(0.5377, 0.6733, 0.5076);  // askew to all axes, so that it meets no edge by design of the part
    bool inside = false;
    for (const std::uint32_t t : triangles_[outer])
      if (meets(from, way, given_.corners[t])) inside = !inside;
    return inside;
  }

  /// Returns true if a ray meets a triangle (Moeller, Trumbore, "Fast, minimum storage ray/triangle intersection",
  /// 1997).
  bool meets(const Vector3d& from, const Vector3d& way, const std::array<std::uint32_t, 3>& c) const {
    const Vector3d& a = given_.points[c[0]];
    const Vector3d ab = given_.points[c[1]] - a, ac = given_.points[c[2]] - a, p = way.cross(ac), to = from - a;
    const double det = ab.dot(p);
    if (det == 0) return false;
    const double u = to.dot(p) / det;
    const Vector3d q = to.cross(ab);
    const double v = way.dot(q) / det;
    return u >= 0 && v >= 0 && u + v < 1 && ac.dot(q) / det > 0;
  }

  const Shells& given_;
  Nesting found_;
  std::vector<std::vector<std::uint32_t>> triangles_;
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::size_t tried_ = 0, boxes_tried_ = 0;
};

}  // namespace

Nesting nestingOf(const Shells& shells) {
  return Nest(shells).run();
}

}  // namespace hapticd::importing
