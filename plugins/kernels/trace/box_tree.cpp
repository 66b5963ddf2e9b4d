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

/// The control net of one Bezier piece in homogeneous coordinates, with its parameter range.
struct Piece {
  int count_u = 0, count_v = 0;
  std::vector<Vector4d> points;  ///< (w x, w y, w z, w), u-major
  Eigen::Array2d lo, hi;

  Vector3d point(int i, int j) const {
    const Vector4d& h = points[static_cast<std::size_t>(i * count_v + j)];
    return h.head<3>() / h[3];
  }
  /// Calls `use` for each edge of the control polygons along an axis.
  template <class F>
  void forEachEdge(int axis, F&& use) const {
    const int du = axis == 0 ? 1 : 0, dv = 1 - du;
    for (int i = 0; i + du < count_u; ++i)
      for (int j = 0; j + dv < count_v; ++j) use(Vector3d(point(i + du, j + dv) - point(i, j)));
  }
  /// Returns the unit mean direction of the edges along an axis, or 0 if they have no length.
  Vector3d mean(int axis) const {
    Vector3d sum = Vector3d::Zero();
    forEachEdge(axis, [&sum](const Vector3d& edge) { sum += edge; });
    const double length = sum.norm();
    return length > 0 ? Vector3d(sum / length) : sum;
  }
  /// Returns the surface point at the middle of the parameters.
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

/// Halves a piece along an axis by de Casteljau's algorithm.
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

/// Returns the largest turn of the control polygons along an axis, as 1 - cos of the angle to their mean direction.
double turn(const Piece& piece, int axis) {
  const Vector3d mean = piece.mean(axis);
  double widest = 0;
  piece.forEachEdge(axis, [&](const Vector3d& edge) {
    const double length = edge.norm();
    if (length > 0) widest = std::max(widest, 1 - edge.dot(mean) / length);
  });
  return std::min(widest, 2.0);
}

/// Returns how far the control polygons along an axis turn along themselves: the largest turn within one of them, as
/// 1 - cos of the angle to its own mean direction.
double turnAlong(const Piece& piece, int axis) {
  const int lines = axis == 0 ? piece.count_v : piece.count_u, count = axis == 0 ? piece.count_u : piece.count_v;
  double widest = 0;
  for (int line = 0; line < lines; ++line) {
    const auto at = [&](int i) { return axis == 0 ? piece.point(i, line) : piece.point(line, i); };
    const Vector3d mean = (at(count - 1) - at(0)).normalized();
    for (int i = 0; i + 1 < count; ++i) {
      const Vector3d edge = at(i + 1) - at(i);
      if (const double length = edge.norm(); length > 0) widest = std::max(widest, 1 - edge.dot(mean) / length);
    }
  }
  return std::min(widest, 2.0);
}

/// Returns the axis along which a piece is halved: the one whose control polygons turn most. If they hardly turn along
/// themselves, they turn from one polygon to the next, and only halves across them turn less.
int axisToHalve(const Piece& piece, double turn_u, double turn_v) {
  constexpr double kHardly = 0.1;  // relative to the turn of all polygons
  const int axis = turn_u >= turn_v ? 0 : 1;
  return turnAlong(piece, axis) < kHardly * std::max(turn_u, turn_v) ? 1 - axis : axis;
}

/// Returns an estimate [rad] of the largest angle between `normal` and the normals of a nearly flat piece: 1.25 times
/// the largest angle over the quadrilaterals of its control net, plus 0.02 rad. Returns pi if a quadrilateral has no
/// normal.
double turnOfNormal(const Piece& piece, const Vector3d& normal) {
  constexpr double kMore = 1.25, kLeast = 0.02;
  double widest = 0;
  for (int i = 0; i + 1 < piece.count_u; ++i)
    for (int j = 0; j + 1 < piece.count_v; ++j) {
      const Vector3d a = piece.point(i + 1, j + 1) - piece.point(i, j),
                     b = piece.point(i, j + 1) - piece.point(i + 1, j);
      const Vector3d across = a.cross(b);
      const double size = across.norm();
      if (!(size > 1e-9 * a.norm() * b.norm()) || !(size > 0)) return std::numbers::pi;
      widest = std::max(widest, std::acos(std::clamp(across.dot(normal) / size, -1.0, 1.0)));
    }
  return kMore * widest + kLeast;
}

constexpr int kMaxHalvings = 7;  // most halvings of one Bezier piece, which give at most 128 leaves

void addLeaves(const Piece& piece, int patch, double flat, int halvings, std::vector<Leaf>& leaves) {
  const double turn_u = turn(piece, 0), turn_v = turn(piece, 1);
  if (halvings < kMaxHalvings && std::max(turn_u, turn_v) > flat) {
    for (const Piece& half : halves(piece, axisToHalve(piece, turn_u, turn_v)))
      addLeaves(half, patch, flat, halvings + 1, leaves);
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
  // The tangents along u and along v stay in cones about their means. The smaller the angle between the two means, the
  // more the normal can turn; this is why the cone is divided by its sine.
  if (sine > 0) leaf.normal = normal / sine;
  leaf.cone = sine > 0 ? (std::acos(1 - turn_u) + std::acos(1 - turn_v)) / sine : std::numbers::pi;
  if (sine > 0) leaf.cone = std::min(leaf.cone, turnOfNormal(piece, leaf.normal));
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

void BoxTree::add(const spline::SurfaceData& patch, int index, double flat) {
  for (const spline::SurfaceData& bezier : spline::bezierPieces(patch))
    addLeaves(pieceOf(bezier), index, flat, 0, leaves_);
}

/// Builds one tree per patch. The leaves are already in the order of the patches.
void BoxTree::build() {
  nodes_.clear();
  nodes_.reserve(2 * leaves_.size());
  roots_.clear();
  for (int first = 0, end = 0; first < leafCount(); first = end) {
    while (end < leafCount() && leaf(end).patch == leaf(first).patch) ++end;
    roots_.push_back(buildNode(first, end - first));
  }
}

Eigen::AlignedBox3d BoxTree::bounds() const noexcept {
  Eigen::AlignedBox3d box;
  for (const int root : roots_) box.extend(nodes_[static_cast<std::size_t>(root)].box);
  return box;
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
  nodes_[static_cast<std::size_t>(index)] = Node{box, first, count, first};
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

struct BoxTree::Query {
  const Vector3d& p;
  double radius, margin;
  std::span<const int> parts;
  std::vector<double> upper;  ///< [m] for each part, an upper bound of the distance to it
  std::vector<LeafHit>& hits;
  /// nodes still to be examined: squared distance [m^2] of the box, and index
  std::vector<std::pair<double, int>> open;

  /// Returns the squared distance [m^2] beyond which boxes of a part are left out.
  double limit2(int part) const {
    const double limit = std::min(radius, upper[static_cast<std::size_t>(part)] + margin);
    return limit * limit;
  }
};

/// Collects the leaves of a patch. Nearer boxes are examined first, so that the limit falls early.
void BoxTree::lookAt(int root, Query& query) const {
  const int part = query.parts[static_cast<std::size_t>(leaf(nodes_[static_cast<std::size_t>(root)].leaf).patch)];
  double limit2 = query.limit2(part);
  query.open.assign(1, {nodes_[static_cast<std::size_t>(root)].box.squaredExteriorDistance(query.p), root});
  while (!query.open.empty()) {
    const auto [distance2, index] = query.open.back();
    query.open.pop_back();
    if (!(distance2 <= limit2)) continue;
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.count == 0) {
      const auto entry = [&](int child) {
        return std::pair(nodes_[static_cast<std::size_t>(child)].box.squaredExteriorDistance(query.p), child);
      };
      auto nearer = entry(index + 1), farther = entry(node.first);
      if (farther.first < nearer.first) std::swap(nearer, farther);
      query.open.push_back(farther);
      query.open.push_back(nearer);
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const double leaf2 = leaf(i).box.squaredExteriorDistance(query.p);
      if (!(leaf2 <= limit2)) continue;
      query.hits.push_back({leaf2, i});
      double& upper = query.upper[static_cast<std::size_t>(part)];
      const double center = (query.p - leaf(i).center).norm();  // distance to a point of the surface, so an upper bound
      if (center >= upper) continue;
      upper = center;
      limit2 = query.limit2(part);
    }
  }
}

void BoxTree::near(const Vector3d& p, double radius, double margin, std::span<const int> parts, int part_count,
                   std::vector<LeafHit>& hits) const {
  hits.clear();
  Query query{p, radius, margin, parts, std::vector<double>(static_cast<std::size_t>(part_count), radius), hits, {}};
  std::vector<std::pair<double, int>> patches;
  for (const int root : roots_) {
    const double distance2 = nodes_[static_cast<std::size_t>(root)].box.squaredExteriorDistance(p);
    if (distance2 <= radius * radius) patches.emplace_back(distance2, root);
  }
  std::sort(patches.begin(), patches.end());
  for (const auto& [distance2, root] : patches) lookAt(root, query);
  std::vector<char> seen(parts.size(), 0);
  // remove leaves that were collected before the limit fell below their distance
  std::erase_if(hits, [&](const LeafHit& hit) {
    const auto patch = static_cast<std::size_t>(leaf(hit.leaf).patch);
    const bool far = hit.distance2 > query.limit2(parts[patch]);
    if (!far) seen[patch] = 1;
    return far;
  });
  for (const auto& [distance2, root] : patches) {
    const int first = nodes_[static_cast<std::size_t>(root)].leaf;
    const auto patch = static_cast<std::size_t>(leaf(first).patch);
    if (seen[patch] == 0)
      // no leaf of this patch is within the limit
      hits.push_back({std::max(distance2, query.limit2(parts[patch])), first});
  }
  std::sort(hits.begin(), hits.end(), [](const LeafHit& a, const LeafHit& b) {
    return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.leaf < b.leaf;
  });
}

}  // namespace hapticd::trace
