// SPDX-License-Identifier: MIT
#include "import/press_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace hapticd::importing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCells = 65;  ///< odd, so that the middle of the side is the middle of a cell
constexpr int kAround = 4;  ///< a hand strays over so many cells, 6 % of the side
constexpr double kNothing = -std::numeric_limits<double>::infinity();

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The model as the hand sees it before it presses: how high the surface is in each cell of a grid over the side.
class HeightMap {
 public:
  HeightMap(const Eigen::AlignedBox3d& box, int axis)
      : box_(box), axis_(axis), height_(kCells * kCells, kNothing), faces_(kCells * kCells, true) {}
  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c);
  /// [m^2] Returns the area of the side over which the surface lies.
  double seen() const;
  /// Returns the best place; the middle of the side if no surface lies over any cell.
  PressPlace best() const;

 private:
  Vector2d flat(const Vector3d& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }
  Vector2d cell() const { return flat(box_.sizes()).cwiseMax(1e-12) / kCells; }
  Vector2d middleOf(int i, int j) const { return flat(box_.min()) + cell().cwiseProduct(Vector2d(i + 0.5, j + 0.5)); }
  double unevenness(int i, int j) const;
  Eigen::AlignedBox3d box_;
  int axis_;
  std::vector<double> height_;
  std::vector<bool> faces_;  ///< whether the outside is seen
};

void HeightMap::add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector2d corner[] = {flat(a), flat(b), flat(c)};
  const double area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  if (area == 0) return;
  const Vector2d least = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]) - flat(box_.min());
  const Vector2d most = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]) - flat(box_.min());
  const auto index = [](double cells) { return std::clamp(static_cast<int>(std::floor(cells)), 0, kCells - 1); };
  for (int i = index(least.x() / cell().x()); i <= index(most.x() / cell().x()); ++i)
    for (int j = index(least.y() / cell().y()); j <= index(most.y() / cell().y()); ++j) {
      const Vector2d p = middleOf(i, j);
      const double of_b = cross(p - corner[0], corner[2] - corner[0]) / area;
      const double of_c = cross(corner[1] - corner[0], p - corner[0]) / area;
      constexpr double kRounding = -1e-9;  // no gap where triangles meet
      if (std::min({of_b, of_c, 1 - of_b - of_c}) < kRounding) continue;
      const double height = a[axis_] + of_b * (b[axis_] - a[axis_]) + of_c * (c[axis_] - a[axis_]);
      const auto at = static_cast<std::size_t>(i * kCells + j);
      if (height <= height_[at]) continue;
      height_[at] = height;
      faces_[at] = area > 0;
    }
}

/// [m] Returns by how much the surface around a cell is higher or lower, on average. Where there is none, it counts as
/// far away.
double HeightMap::unevenness(int i, int j) const {
  const double own = height_[static_cast<std::size_t>(i * kCells + j)], far = box_.diagonal().norm();
  double sum = 0;
  for (int k = i - kAround; k <= i + kAround; ++k)
    for (int l = j - kAround; l <= j + kAround; ++l) {
      const bool in = k >= 0 && l >= 0 && k < kCells && l < kCells;
      const double height = in ? height_[static_cast<std::size_t>(k * kCells + l)] : kNothing;
      sum += height == kNothing ? far : std::abs(height - own);
    }
  return sum / ((2 * kAround + 1) * (2 * kAround + 1));
}

double HeightMap::seen() const {
  const auto empty = std::count(height_.begin(), height_.end(), kNothing);
  return static_cast<double>(kCells * kCells - empty) * cell().prod();
}

PressPlace HeightMap::best() const {
  constexpr double kWeight = 4;  // an even place is worth a way from the middle
  PressPlace place{box_, Vector3d::Unit(axis_), Vector3d::Zero()};
  place.point = place.middleOfSide();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const auto at = static_cast<std::size_t>(i * kCells + j);
      if (height_[at] == kNothing) continue;
      const Vector2d p = middleOf(i, j);
      const double cost = (p - flat(box_.center())).norm() + kWeight * unevenness(i, j);
      if (cost >= least) continue;
      least = cost;
      place.point[axis_] = height_[at];
      place.point[(axis_ + 1) % 3] = p.x();
      place.point[(axis_ + 2) % 3] = p.y();
      place.faces_hand = faces_[at];
    }
  return place;
}

}  // namespace

PressPlace pressPlace(const Triangles& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& corners : mesh.corners)
    for (const std::uint32_t corner : corners) box.extend(mesh.points[corner]);
  const auto seenAlong = [&](int axis) {
    HeightMap map(box, axis);
    for (const auto& [a, b, c] : mesh.corners) map.add(mesh.points[a], mesh.points[b], mesh.points[c]);
    return map;
  };
  HeightMap chosen = seenAlong(2);
  for (const int axis : {1, 0}) {
    constexpr double kFar = 2;  // how much broader another side must be
    HeightMap map = seenAlong(axis);
    if (map.seen() > kFar * chosen.seen()) chosen = std::move(map);
  }
  return chosen.best();
}

}  // namespace hapticd::importing
