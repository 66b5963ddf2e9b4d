// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_slivers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "mesh_import/mesh_edges.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
using Corners = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNoTriangle = 0xffffffffu;

bool hasEqualCorners(const Corners& c) {
  return c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
}

/// Returns which edge of a triangle is the longest; edge k runs from corner k to the next one.
std::uint32_t longestEdge(const std::vector<Vector3d>& points, const Corners& c) {
  std::uint32_t longest = 0;
  double most = -1;
  for (std::uint32_t k = 0; k < 3; ++k)
    if (const double length = (points[c[(k + 1) % 3]] - points[c[k]]).squaredNorm(); length > most) {
      most = length;
      longest = k;
    }
  return longest;
}

std::size_t countFree(const TriangleCorners& corners) {
  const std::vector<MeshEdge> edges = meshEdges(corners);
  std::size_t free = 0;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    end = endOfEdge(edges, i);
    free += end - i == 1 ? 1 : 0;
  }
  return free;
}

/// Returns the median length of the edges. Those of a border may all be as short as rounding, at the pole of a ball.
double medianEdge(const std::vector<Vector3d>& points, const std::vector<MeshEdge>& edges) {
  std::vector<double> lengths;
  lengths.reserve(edges.size());
  for (const MeshEdge& edge : edges)
    lengths.push_back((points[edge.ends >> 32] - points[edge.ends & 0xffffffffu]).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

/// Gives points within a distance of each other the same number, by a grid of cells of that size.
class Near {
 public:
  Near(const std::vector<Vector3d>& points, double distance) : points_(points), distance_(distance) {}

  /// Returns a point that was given before and is near this one, else the point itself.
  std::uint32_t at(std::uint32_t point) {
    const Cell own = cellOf(points_[point]);
    for (int i = 0; i < 27; ++i) {
      const auto found = first_.find({own[0] + i % 3 - 1, own[1] + i / 3 % 3 - 1, own[2] + i / 9 - 1});
      if (found != first_.end() && (points_[found->second] - points_[point]).norm() <= distance_) return found->second;
    }
    first_.emplace(own, point);
    return point;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cellOf(const Vector3d& p) const {
    return {std::llround(p.x() / distance_), std::llround(p.y() / distance_), std::llround(p.z() / distance_)};
  }
  const std::vector<Vector3d>& points_;
  double distance_;
  std::map<Cell, std::uint32_t> first_;
};

/// True if the middle corner of a triangle is so near to its longest edge that rounding decides where the triangle
/// looks, or if the triangle is empty.
bool isSliver(const std::vector<Vector3d>& points, const Corners& c, double rounding) {
  if (isEmptyTriangle(points, c)) return true;
  const Vector3d ab = points[c[1]] - points[c[0]], ac = points[c[2]] - points[c[0]];
  const std::uint32_t k = longestEdge(points, c);
  const double length = (points[c[(k + 1) % 3]] - points[c[k]]).norm();
  return ab.cross(ac).norm() <= std::min(rounding, kSmallShare * length) * length;
}

/// Cuts the neighbour of a sliver in two at the sliver's middle corner; the sliver becomes the second half. Returns
/// false, and changes nothing, if that corner is one of the neighbour's.
/// @param code the neighbour, and which of its edges is the longest edge of the sliver
bool cutNeighbour(const std::vector<Vector3d>& points, std::uint32_t code, Corners& sliver, Corners& neighbour) {
  const std::uint32_t middle = sliver[(longestEdge(points, sliver) + 2) % 3], m = code % 4;
  const std::uint32_t from = neighbour[m], to = neighbour[(m + 1) % 3], apex = neighbour[(m + 2) % 3];
  if (apex == middle) return false;
  neighbour = {from, middle, apex};
  sliver = {middle, to, apex};
  return true;
}

}  // namespace

double roundingOf(const std::vector<Vector3d>& points, const TriangleCorners& corners) {
  constexpr double kRounding = 5e-7;
  double largest = 0;
  for (const Corners& c : corners)
    for (const std::uint32_t i : c) largest = std::max(largest, points[i].lpNorm<Eigen::Infinity>());
  return kRounding * largest;
}

bool isEmptyTriangle(const std::vector<Vector3d>& points, const Corners& c) {
  if (hasEqualCorners(c)) return true;
  const Vector3d ab = points[c[1]] - points[c[0]], ac = points[c[2]] - points[c[0]];
  return !(ab.cross(ac).norm() > 1e-14 * ab.norm() * ac.norm());
}

std::size_t takeInSlivers(const std::vector<Vector3d>& points, double rounding, MeshTriangles& triangles) {
  constexpr int kMostRounds = 64;  // a sliver beside a sliver waits until that one is gone
  TriangleCorners& corners = triangles.corners;
  std::size_t taken = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<std::uint32_t> slivers;
    for (std::uint32_t t = 0; t < corners.size(); ++t)
      if (!hasEqualCorners(corners[t]) && isSliver(points, corners[t], rounding)) slivers.push_back(t);
    if (slivers.empty()) break;
    const std::vector<std::uint32_t> across = pairedNeighbours(meshEdges(corners), corners.size());
    std::vector<char> changed(corners.size(), 0);
    const std::size_t before = taken;
    for (const std::uint32_t t : slivers) {
      const std::uint32_t code = across[3 * t + longestEdge(points, corners[t])];
      if (code == kNoTriangle || changed[t] != 0 || changed[code / 4] != 0) continue;
      if (isSliver(points, corners[code / 4], rounding)) continue;
      if (!cutNeighbour(points, code, corners[t], corners[code / 4])) continue;
      triangles.from[t] = triangles.from[code / 4];
      changed[t] = changed[code / 4] = 1;
      ++taken;
    }
    if (taken == before) break;
  }
  return taken;
}

std::size_t joinFreePoints(const std::vector<Vector3d>& points, double rounding, MeshTriangles& triangles) {
  constexpr double kLeast = 2e-10;  // of the rounding: the numbers of smaller cells are no whole numbers
  const std::vector<MeshEdge> edges = meshEdges(triangles.corners);
  std::vector<char> free(points.size(), 0);
  std::size_t count = 0;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    end = endOfEdge(edges, i);
    if (end - i > 1) continue;
    free[edges[i].ends >> 32] = free[edges[i].ends & 0xffffffffu] = 1;
    ++count;
  }
  if (count == 0 || !(rounding > 0)) return 0;
  // a part far from the origin has more digits than those of single precision
  const double distance = std::min(rounding, kSmallShare * medianEdge(points, edges));
  if (!(distance > kLeast * rounding)) return 0;
  Near near(points, distance);
  std::vector<std::uint32_t> number(points.size());
  std::size_t joined = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    number[i] = free[i] != 0 ? near.at(i) : i;
    joined += number[i] != i ? 1 : 0;
  }
  if (joined == 0) return 0;
  MeshTriangles sewn = triangles;
  for (Corners& c : sewn.corners) c = {number[c[0]], number[c[1]], number[c[2]]};
  sewn.eraseIf([&](std::size_t t) { return hasEqualCorners(sewn.corners[t]); });
  if (countFree(sewn.corners) >= count) return 0;
  triangles = std::move(sewn);
  return joined;
}

}  // namespace hapticd::importing
