// SPDX-License-Identifier: MIT
#include "kernels/medial/mesh_contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

constexpr int kMostCells = 256;           ///< most cells along a side; a power of two
constexpr double kMargin = 0.01;          ///< share of the body's size, as a margin around it
constexpr double kClear = 1e-9;           ///< least distance of a corner from the surface, as a share of a cell
constexpr int kSettle = 2;                ///< steps that move a vertex onto the surface
constexpr uint64_t kStride = 1ULL << 20;  ///< more than twice any coordinate of a corner

uint64_t keyOf(const Eigen::Vector3i& c) {
  return (static_cast<uint64_t>(c.x()) * kStride + static_cast<uint64_t>(c.y())) * kStride +
         static_cast<uint64_t>(c.z());
}

}  // namespace

MeshContour::MeshContour(const MedialMesh& mesh, double chord_error) : mesh_(&mesh) {
  const double size = mesh.bounds().sizes().maxCoeff() * (1 + 2 * kMargin);
  if (!(size > 0) || !(chord_error > 0)) return;
  // The sagitta of a chord of length h on a circle of radius r is h^2 / (8 r).
  const double wanted = std::sqrt(8 * std::max(mesh.leastRadius(), size * 1e-3) * chord_error);
  int cells = 8;
  while (cells < kMostCells && size / cells > wanted) cells *= 2;
  cell_ = size / cells;
  origin_ = mesh.bounds().center() - Vector3d::Constant(size / 2);
  visit(Cell::Zero(), cells);
  distances_ = {};
  crossings_ = {};
}

/// The distance to the surface changes at most by the length of the path. So if the middle of a cube is farther from
/// the surface than from its own corners, the surface does not pass through this cube.
void MeshContour::visit(const Cell& low, int size) {
  const Vector3d middle = place(low) + Vector3d::Constant(0.5 * size * cell_);
  MeshFeet feet;
  mesh_->nearest(middle, start_, 0, feet);
  start_ = feet.feet[0].element;
  if (std::fabs(feet.feet[0].distance) > 0.5 * std::sqrt(3.0) * size * cell_ * (1 + kMargin)) return;
  if (size == 1) return cut(low);
  for (int k = 0; k < 8; ++k) visit(low + size / 2 * Cell(k & 1, (k >> 1) & 1, k >> 2), size / 2);
}

double MeshContour::distanceAt(const Cell& corner) {
  const auto [known, added] = distances_.try_emplace(keyOf(corner), 0.0);
  if (!added) return known->second;
  MeshFeet feet;
  mesh_->nearest(place(corner), start_, 0, feet);
  double distance = feet.feet[0].distance;
  // no corner lies on the surface, so that each vertex belongs to one edge
  if (std::fabs(distance) < kClear * cell_) distance = kClear * cell_;
  return known->second = distance;
}

/// Divides the cell into six tetrahedra about a diagonal. Neighbouring cells then share the triangles of their common
/// side.
void MeshContour::cut(const Cell& cell) {
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (std::size_t k = 0; k < kOrders.size(); ++k) {
    std::array<Cell, 4> corners{cell, cell, cell, cell + Cell::Ones()};
    corners[1][kOrders[k][0]] += 1;
    corners[2] = corners[1];
    corners[2][kOrders[k][1]] += 1;
    if (k >= 3) std::swap(corners[1], corners[2]);  // for odd orders the tetrahedron would be inside out
    std::array<double, 4> distances;
    for (std::size_t i = 0; i < 4; ++i) distances[i] = distanceAt(corners[i]);
    tetrahedron(corners, distances);
  }
}

/// Adds the triangles of one tetrahedron. Its corners must span a positive volume: the crossings on the edges 0-1, 0-2
/// and 0-3 are then counter-clockwise if seen from beyond them.
void MeshContour::tetrahedron(const std::array<Cell, 4>& corners, const std::array<double, 4>& distances) {
  std::array<std::size_t, 4> inside{}, outside{};
  std::size_t in = 0, out = 0;
  for (std::size_t i = 0; i < 4; ++i) (distances[i] < 0 ? inside[in++] : outside[out++]) = i;
  if (in == 0 || out == 0) return;
  const auto crossing = [&](std::size_t a, std::size_t b) {
    return vertexOn(corners[a], distances[a], corners[b], distances[b]);
  };
  // True if the order of the four corners is an even permutation.
  const auto even = [](std::array<std::size_t, 4> order) {
    int swaps = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) swaps += order[i] > order[j] ? 1 : 0;
    return swaps % 2 == 0;
  };
  const auto emit = [this](uint32_t a, uint32_t b, uint32_t c, bool turn) {
    turn ? triangle(a, c, b) : triangle(a, b, c);
  };
  if (in == 1) {
    const std::size_t i = inside[0];
    emit(crossing(i, outside[0]), crossing(i, outside[1]), crossing(i, outside[2]),
         !even({i, outside[0], outside[1], outside[2]}));
  } else if (in == 3) {
    const std::size_t o = outside[0];
    emit(crossing(o, inside[0]), crossing(o, inside[1]), crossing(o, inside[2]),
         even({o, inside[0], inside[1], inside[2]}));
  } else {
    const uint32_t a = crossing(inside[0], outside[0]), b = crossing(inside[0], outside[1]);
    const uint32_t c = crossing(inside[1], outside[1]), d = crossing(inside[1], outside[0]);
    const bool turn = !even({inside[0], inside[1], outside[0], outside[1]});
    emit(a, b, c, turn);
    emit(a, c, d, turn);
  }
}

uint32_t MeshContour::vertexOn(const Cell& a, double at_a, const Cell& b, double at_b) {
  const auto [known, added] = crossings_.try_emplace(keyOf(a + b), 0U);
  if (!added) return known->second;
  Vector3d p = place(a) + at_a / (at_a - at_b) * (place(b) - place(a));
  MeshFeet feet;
  for (int i = 0; i <= kSettle; ++i) {
    mesh_->nearest(p, start_, 0, feet);
    if (i < kSettle) p -= feet.feet[0].distance * feet.feet[0].normal;
  }
  const MeshFoot& foot = feet.feet[0];
  const MedialMesh::Element& element = mesh_->elements()[foot.element];
  const std::array<double, 3> weights = mesh_->weights(foot.element, foot.parameter);
  std::array<Share, 3> shares{};
  for (std::size_t i = 0; i < element.count; ++i) shares[i] = {element.vertex[i], static_cast<float>(weights[i])};
  return known->second = add(foot.center, foot.normal, foot.radius, {shares.data(), element.count});
}

}  // namespace hapticd::medial
