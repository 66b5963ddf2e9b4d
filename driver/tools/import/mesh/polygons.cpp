// SPDX-License-Identifier: MIT
#include "mesh_import/polygons.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace hapticd::importing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;
constexpr std::size_t kMostTests = 1'000'000'000;  ///< tests of a corner against an ear: some seconds

/// Returns twice the area of a triangle, positive if it runs anticlockwise.
double areaOf(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

/// Cuts a polygon that runs anticlockwise in a plane ear by ear (Meisters, "Polygons have ears", 1975).
class Ears {
 public:
  explicit Ears(std::vector<Vector2d> corners) : p_(std::move(corners)), next_(p_.size()), before_(p_.size()) {
    const auto n = static_cast<std::uint32_t>(p_.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      before_[i] = (i + n - 1) % n;
    }
    for (std::uint32_t i = 0; i < n; ++i)
      if (!(areaAt(i) > 0)) hollow_.push_back(i);
  }

  /// Returns the triangles as indices of corners; too few if that takes too long.
  Triangles run() {
    Triangles triangles;
    std::uint32_t at = 0;
    for (std::size_t left = p_.size(); left >= 3 && tests_ < kMostTests; --left) {
      at = earFrom(at, left);
      triangles.push_back({before_[at], at, next_[at]});
      next_[before_[at]] = next_[at];
      before_[next_[at]] = before_[at];
      std::erase_if(hollow_, [&](std::uint32_t i) { return i == at || areaAt(i) > 0; });
      at = next_[at];
    }
    return triangles;
  }

 private:
  double areaAt(std::uint32_t i) const { return areaOf(p_[before_[i]], p_[i], p_[next_[i]]); }

  /// Returns the first ear at or after a corner. A polygon that crosses itself may have none: then a corner on a
  /// straight line is returned, or the given one.
  std::uint32_t earFrom(std::uint32_t from, std::size_t left) {
    std::uint32_t straight = from;
    for (std::uint32_t i = from; left > 0 && tests_ < kMostTests; --left, i = next_[i]) {
      if (isEar(i)) return i;
      if (areaAt(i) == 0 && areaAt(straight) != 0) straight = i;
    }
    return straight;
  }

  bool isEar(std::uint32_t i) {
    if (!(areaAt(i) > 0)) return false;
    const Vector2d &a = p_[before_[i]], &b = p_[i], &c = p_[next_[i]];
    return std::none_of(hollow_.begin(), hollow_.end(), [&](std::uint32_t k) {
      ++tests_;
      const Vector2d& q = p_[k];  // the ends of a slit to a hole have equal points
      if (q == a || q == b || q == c) return false;
      return areaOf(a, b, q) >= 0 && areaOf(b, c, q) >= 0 && areaOf(c, a, q) >= 0;
    });
  }

  std::vector<Vector2d> p_;
  std::vector<std::uint32_t> next_, before_;
  std::vector<std::uint32_t> hollow_;  ///< corners that are not convex: only these can lie inside an ear
  std::size_t tests_ = 0;
};

/// Returns a normal whose length is twice the area (Newell's method).
Vector3d normalOf(const std::vector<Vector3d>& points, const std::vector<std::uint32_t>& polygon) {
  Vector3d normal = Vector3d::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k)
    normal += (points[polygon[k - 1]] - points[polygon[0]]).cross(points[polygon[k]] - points[polygon[0]]);
  return normal;
}

std::vector<Vector2d> inPlane(const std::vector<Vector3d>& points, const std::vector<std::uint32_t>& polygon,
                              const Vector3d& normal) {
  const Vector3d u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
  std::vector<Vector2d> flat;
  flat.reserve(polygon.size());
  for (const std::uint32_t i : polygon) {
    const Vector3d p = points[i] - points[polygon[0]];
    flat.emplace_back(u.dot(p), v.dot(p));
  }
  return flat;
}

/// Cuts off what repeats the whole polygon: some files go round more than once.
void dropRounds(std::vector<std::uint32_t>& polygon) {
  for (std::size_t round = 1; 2 * round <= polygon.size(); ++round) {
    if (polygon[round] != polygon[0] || polygon.size() % round != 0) continue;
    if (!std::equal(polygon.begin() + static_cast<std::ptrdiff_t>(round), polygon.end(), polygon.begin())) continue;
    return polygon.resize(round);
  }
}

}  // namespace

bool cutPolygon(const std::vector<Vector3d>& points, std::vector<std::uint32_t> polygon, Triangles& corners) {
  if (polygon.size() < 3) return true;
  const std::array<std::uint32_t, 3> first{polygon[0], polygon[1], polygon[2]};
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  while (polygon.size() > 1 && polygon.back() == polygon.front()) polygon.pop_back();
  dropRounds(polygon);
  if (polygon.size() < 3) return corners.push_back(first), true;  // counted among the triangles of zero area
  const auto fan = [&] {
    for (std::size_t k = 2; k < polygon.size(); ++k) corners.push_back({polygon[0], polygon[k - 1], polygon[k]});
    return true;
  };
  if (polygon.size() == 3) return fan();
  const Vector3d normal = normalOf(points, polygon);
  if (!(normal.norm() > 0)) return fan();
  std::vector<Vector2d> flat = inPlane(points, polygon, normal);
  bool one_sense = true;
  for (std::size_t k = 2; k < flat.size() && one_sense; ++k) one_sense = areaOf(flat[0], flat[k - 1], flat[k]) > 0;
  if (one_sense) return fan();
  const Triangles cut = Ears(std::move(flat)).run();
  for (const auto& c : cut) corners.push_back({polygon[c[0]], polygon[c[1]], polygon[c[2]]});
  return cut.size() + 2 == polygon.size();
}

}  // namespace hapticd::importing
