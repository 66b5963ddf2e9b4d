// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_coincident.hpp"

#include <algorithm>

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
using Corners = std::array<std::uint32_t, 3>;

/// Which triangles have a point as their corner.
class Around {
 public:
  Around(std::size_t points, const TriangleCorners& corners) : corners_(corners), first_(points + 1, 0) {
    for (const Corners& c : corners)
      for (const std::uint32_t i : c) ++first_[i + 1];
    for (std::size_t i = 0; i < points; ++i) first_[i + 1] += first_[i];
    triangles_.resize(3 * corners.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < corners.size(); ++t)
      for (const std::uint32_t i : corners[t]) triangles_[next[i]++] = t;
  }

  /// Calls see(triangle) for the triangles around a point.
  template <class See>
  void each(std::uint32_t point, const See& see) const {
    for (std::uint32_t i = first_[point]; i < first_[point + 1]; ++i) see(triangles_[i]);
  }

  /// Returns the points that have an edge with a point, sorted.
  std::vector<std::uint32_t> neighbours(std::uint32_t point) const {
    std::vector<std::uint32_t> found;
    each(point, [&](std::uint32_t t) {
      for (const std::uint32_t i : corners_[t])
        if (i != point) found.push_back(i);
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  const TriangleCorners& corners_;
  std::vector<std::uint32_t> first_, triangles_;
};

/// True if an edge is short beside the other edges of a triangle.
bool isShortIn(const std::vector<Vector3d>& points, const Corners& c, double length) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (points[c[(k + 1) % 3]] - points[c[k]]).norm());
  return length < kSmallShare * longest;
}

/// True if the ends of an edge have no common neighbours but those of its two triangles: then no two other triangles
/// come to lie on each other when the ends are joined.
bool mayJoin(const Around& around, std::uint32_t a, std::uint32_t b) {
  const std::vector<std::uint32_t> of_a = around.neighbours(a), of_b = around.neighbours(b);
  std::vector<std::uint32_t> common;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
  return common.size() == 2;
}

/// Joins the ends of short edges that have no triangle in common with one another. Returns how many it has joined.
std::size_t joinOnce(const std::vector<Vector3d>& points, double rounding, MeshTriangles& triangles) {
  TriangleCorners& corners = triangles.corners;
  const std::vector<MeshEdge> edges = meshEdges(corners);
  std::vector<std::array<std::uint32_t, 2>> found;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    end = endOfEdge(edges, i);
    const auto a = static_cast<std::uint32_t>(edges[i].ends >> 32), b = static_cast<std::uint32_t>(edges[i].ends);
    const double length = (points[b] - points[a]).norm();
    if (end - i != 2 || !(length <= rounding)) continue;
    if (!isShortIn(points, corners[edges[i].code / 4], length)) continue;
    if (isShortIn(points, corners[edges[i + 1].code / 4], length)) found.push_back({a, b});
  }
  if (found.empty()) return 0;
  const Around around(points.size(), corners);
  std::vector<char> changed(corners.size(), 0);
  std::size_t joined = 0;
  for (const auto& [a, b] : found) {
    bool free = true;
    for (const std::uint32_t end : {a, b}) around.each(end, [&](std::uint32_t t) { free = free && changed[t] == 0; });
    if (!free || !mayJoin(around, a, b)) continue;
    for (const std::uint32_t end : {a, b}) around.each(end, [&](std::uint32_t t) { changed[t] = 1; });
    const std::uint32_t from = b, to = a;
    around.each(from, [&](std::uint32_t t) { std::replace(corners[t].begin(), corners[t].end(), from, to); });
    ++joined;
  }
  triangles.eraseIf([&](std::size_t t) {
    const Corners& c = corners[t];
    return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
  });
  return joined;
}

}  // namespace

std::size_t joinCoincident(const std::vector<Vector3d>& points, double rounding, MeshTriangles& triangles) {
  constexpr int kMostRounds = 64;  // edges that share a triangle are joined one after another
  std::size_t joined = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::size_t now = joinOnce(points, rounding, triangles);
    joined += now;
    if (now == 0) break;
  }
  return joined;
}

}  // namespace hapticd::importing
