// SPDX-License-Identifier: MIT
#include "kernels/trace/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/spline/refinement.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

/// Rows of the control net of one Bezier piece, homogeneous, with its parameter range.
struct Piece {
  int count_u = 0, count_v = 0;
  std::vector<Vector4d> points;  ///< (w x, w y, w z, w), u-major
  Eigen::Array2d lo, hi;

  Vector3d point(int i, int j) const {
    const Vector4d& h = points[static_cast<std::size_t>(i * count_v + j)];
    return h.head<3>() / h[3];
  }
  /// Edges of the control polygons along an axis.
  template <class F>
  void forEachEdge(int axis, F&& use) const {
    const int du = axis == 0 ? 1 : 0, dv = 1 - du;
    for (int i = 0; i + du < count_u; ++i)
      for (int j = 0; j + dv < count_v; ++j) use(Vector3d(point(i + du, j + dv) - point(i, j)));
  }
  /// Mean direction of those edges, unit; 0 if they have no length.
  Vector3d mean(int axis) const {
    Vector3d sum = Vector3d::Zero();
    forEachEdge(axis, [&sum](const Vector3d& edge) { sum += edge; });
    const double length = sum.norm();
    return length > 0 ? Vector3d(sum / length) : sum;
  }
  /// The surface point at the middle of the parameters.
  Vector3d middle() const;
};

Piece pieceOf(const spline::SurfaceData& data) {
  Piece piece;
  piece.count_u = data.count(0);
  piece.count_v = data.count(1);
  piece.points.reserve(data.points.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const double w = data.weights.empty() ? 1 : data.weights[i];
    piece.points.emplace_back(w * data.points[i].x(), w * data.points[i].y(), w * data.points[i].z(), w);
  }
  for (int axis = 0; axis < 2; ++axis) {
    piece.lo[axis] = data.domain(axis)[0];
    piece.hi[axis] = data.domain(axis)[1];
  }
  return piece;
}

/// Halves a piece along an axis (de Casteljau).
std::array<Piece, 2> halves(const Piece& piece, int axis) {
  std::array<Piece, 2> half{piece, piece};
  const int n = axis == 0 ? piece.count_u : piece.count_v, lines = axis == 0 ? piece.count_v : piece.count_u;
  const int step = axis == 0 ? piece.count_v : 1, stride = axis == 0 ? 1 : piece.count_v;
  for (int line = 0; line < lines; ++line) {
    const auto at = [&](int i) { return static_cast<std::size_t>(line * stride + i * step); };
    for (int level = 0; level < n; ++level) {
      half[0].points[at(level)] = half[1].points[at(0)];
      for (int i = 0; i + level + 1 < n; ++i)
        half[1].points[at(i)] = 0.5 * (half[1].points[at(i)] + half[1].points[at(i + 1)]);
    }
  }
  const double middle = 0.5 * (piece.lo[axis] + piece.hi[axis]);
  half[0].hi[axis] = half[1].lo[axis] = middle;
  return half;
}

Vector3d Piece::middle() const {
  const std::array<Piece, 2> half = halves(*this, 0);
  const std::array<Piece, 2> quarter = halves(half[0], 1);
  return quarter[0].point(count_u - 1, count_v - 1);
}

/// Widest turn of the control polygons along an axis, as 1 - cos of the angle to their mean direction.
double turn(const Piece& piece, int axis) {
  const Vector3d mean = piece.mean(axis);
  double widest = 0;
  piece.forEachEdge(axis, [&](const Vector3d& edge) {
    const double length = edge.norm();
    if (length > 0) widest = std::max(widest, 1 - edge.dot(mean) / length);
  });
  return std::min(widest, 2.0);
}

constexpr double kFlat = 0.03;   // 1 - cos 14 deg: Newton from the middle of such a piece goes straight to the foot
constexpr int kMaxHalvings = 7;  // of one Bezier piece: at most 128 leaves

void addLeaves(const Piece& piece, int patch, int halvings, std::vector<Leaf>& leaves) {
  const double turn_u = turn(piece, 0), turn_v = turn(piece, 1);
  if (halvings < kMaxHalvings && std::max(turn_u, turn_v) > kFlat) {
    for (const Piece& half : halves(piece, turn_u >= turn_v ? 0 : 1)) addLeaves(half, patch, halvings + 1, leaves);
    return;
  }
  Leaf leaf;
  for (int i = 0; i < piece.count_u; ++i)
    for (int j = 0; j < piece.count_v; ++j) leaf.box.extend(piece.point(i, j));
  leaf.middle = 0.5 * (piece.lo + piece.hi);
  leaf.half = 0.5 * (piece.hi - piece.lo);
  leaf.patch = patch;
  leaf.center = piece.middle();
  for (int i = 0; i < piece.count_u; ++i)
    for (int j = 0; j < piece.count_v; ++j)
      leaf.radius = std::max(leaf.radius, (piece.point(i, j) - leaf.center).norm());
  const Vector3d normal = piece.mean(0).cross(piece.mean(1));
  const double sine = normal.norm();
  // The tangents stay in cones about their means; the closer the means are to parallel, the more the normal turns.
  if (sine > 0) leaf.normal = normal / sine;
  leaf.cone = sine > 0 ? (std::acos(1 - turn_u) + std::acos(1 - turn_v)) / sine : std::numbers::pi;
  leaves.push_back(leaf);
}

}  // namespace

bool Leaf::mayFace(const Vector3d& p) const noexcept {
  const Vector3d r = p - center;
  const double distance = r.norm();
  if (!(distance > radius)) return true;
  const double angle = std::asin(radius / distance) + cone;
  return angle >= 0.5 * std::numbers::pi || normal.squaredNorm() == 0 ||
         std::abs(r.dot(normal)) >= std::cos(angle) * distance;
}

void BoxTree::add(const spline::SurfaceData& patch, int index) {
  for (const spline::SurfaceData& bezier : spline::bezierPieces(patch)) addLeaves(pieceOf(bezier), index, 0, leaves_);
}

void BoxTree::build() {
  nodes_.clear();
  nodes_.reserve(2 * leaves_.size());
  if (!leaves_.empty()) buildNode(0, static_cast<int>(leaves_.size()));
}

int BoxTree::buildNode(int first, int count) {
  constexpr int kLeavesPerNode = 4;
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, centers;
  for (int i = first; i < first + count; ++i) {
    box.extend(leaf(i).box);
    centers.extend(leaf(i).box.center());
  }
  nodes_[static_cast<std::size_t>(index)] = Node{box, first, count};
  if (count <= kLeavesPerNode) return index;
  Eigen::Index axis;
  centers.sizes().maxCoeff(&axis);
  const auto begin = leaves_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [axis](const Leaf& a, const Leaf& b) {
    return a.box.min()[axis] + a.box.max()[axis] < b.box.min()[axis] + b.box.max()[axis];
  });
  buildNode(first, count / 2);
  const int right = buildNode(first + count / 2, count - count / 2);
  nodes_[static_cast<std::size_t>(index)].count = 0;
  nodes_[static_cast<std::size_t>(index)].first = right;
  return index;
}

void BoxTree::within(const Vector3d& p, double radius, std::vector<LeafHit>& hits) const {
  hits.clear();
  const double limit = radius * radius;
  std::vector<int> stack;
  if (!nodes_.empty()) stack.push_back(0);
  while (!stack.empty()) {
    const int index = stack.back();
    stack.pop_back();
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!(node.box.squaredExteriorDistance(p) <= limit)) continue;
    if (node.count == 0) {
      stack.push_back(index + 1);
      stack.push_back(node.first);
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const double distance2 = leaf(i).box.squaredExteriorDistance(p);
      if (distance2 <= limit) hits.push_back({distance2, i});
    }
  }
  std::sort(hits.begin(), hits.end(), [](const LeafHit& a, const LeafHit& b) {
    return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.leaf < b.leaf;
  });
}

}  // namespace hapticd::trace
