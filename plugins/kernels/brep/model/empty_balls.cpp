// SPDX-License-Identifier: MIT
/// For a triangle T with the unit normal n, a ball of radius r about x + r n (x in T) holds a point y if
/// |y - x|^2 < 2 r h(y), where h(y) is the height of y over the plane of T. So the least |y - x|^2 / 2 h(y) limits r.
/// Below, |y - x| is bounded from below by a gap: how far y is from T along an axis.
#include "kernels/brep/model/empty_balls.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "kernels/brep/model/model.hpp"
#include "kernels/brep/tree/lanes.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;
using Three = std::array<double, 3>;          ///< numbers of the corners of a triangle
using Halves = std::array<std::uint16_t, 8>;  ///< all numbers of EmptyBalls::sides

constexpr Float4 kZero4{};
constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kLargest = 6;       ///< larger balls than this many radii of a triangle are not looked for
constexpr double kRounding = 1e-14;  ///< of a coordinate: error of a gap or a height
constexpr double kShare = 1 - 1e-6;  ///< of a result, for rounding

/// Returns a bit for each corner of a: it is set if b has the same corner.
std::uint32_t commonCorners(const Triangle& a, const Triangle& b) {
  std::uint32_t common = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (const std::uint32_t j : b.corner) common |= (a.corner[i] == j ? 1u : 0u) << i;
  return common;
}

/// Finds the empty balls of one triangle.
class BallFinder {
 public:
  BallFinder(const Part& part, const BodyTree& tree, std::uint32_t triangle)
      : part_(part), tree_(tree), triangle_(triangle), a_(cornersOf(part, triangle)) {
    const Vector3d n = (a_[1] - a_[0]).cross(a_[2] - a_[0]);
    normal_ = n.normalized();
    center_ = (a_[0] + a_[1] + a_[2]) / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d edge = a_[(k + 1) % 3] - a_[k];
      height_[k] = n.norm() / edge.norm();
      out_[k] = edge.cross(normal_).normalized();
      radius_ = std::max(radius_, (a_[k] - center_).norm());
    }
    const Eigen::AlignedBox3d& box = tree.tree.bounds();
    rounding_ = kRounding * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    rounding4_ = static_cast<float>(tree.tree.margin() + 1e-6 * box.diagonal().norm());
    high_ = normal_.dot(center_ - tree.tree.origin());
    whole_.fill(kLargest * radius_);
    for (Three& slope : slope_) slope.fill(kEndless);
  }

  EmptyBalls find() {
    constexpr double kNarrow = 1e-3;  // height over radius; rounding decides where such a triangle looks
    EmptyBalls balls;
    if (!(*std::min_element(height_.begin(), height_.end()) > kNarrow * radius_)) return balls;
    if (!meetAll()) return balls;
    for (std::size_t side = 0; side < 2; ++side) {
      balls.sides[side].whole = Coarse::down(kShare * whole_[side]).bits();
      for (std::size_t k = 0; k < 3; ++k)
        balls.sides[side].slope[k] = Coarse::down(std::min(kShare * slope_[side][k] * height_[k], 1e30)).bits();
    }
    return balls;
  }

 private:
  /// Meets all triangles that the balls may reach. Returns false if there are too many, as about a long and narrow one.
  bool meetAll() {
    constexpr int kMostNodes = 1024, kMostRows = 512;
    int nodes = 0, rows_met = 0;
    const BoxProbe probe(tree_.tree, center_);
    std::array<std::int32_t, BoxTree::kMaxStack> stack{};
    int depth = 1;
    while (depth > 0) {
      if (++nodes > kMostNodes) return false;
      const BoxNode& node = tree_.tree.node(stack[static_cast<std::size_t>(--depth)]);
      const Test4 rows = Test4{node.child[0], node.child[1], node.child[2], node.child[3]} < 0;
      const std::uint32_t near = bitsOf(boxesWithinReach(node, probe));
      for (std::uint32_t left = near & ~bitsOf(rows); left != 0; left &= left - 1)
        stack[static_cast<std::size_t>(depth++)] = node.child[static_cast<std::size_t>(std::countr_zero(left))];
      if ((near & bitsOf(rows)) == 0) continue;
      const std::uint32_t met = near & bitsOf(rows & rowsWithinReach(node, probe));
      rows_met += std::popcount(met);
      if (rows_met > kMostRows) return false;
      for (std::uint32_t left = met; left != 0; left &= left - 1)
        meetRow(BoxTree::rowOf(node.child[static_cast<std::size_t>(std::countr_zero(left))]));
    }
    return true;
  }

  /// Tests four boxes: false if the balls certainly hold no point of a box.
  Test4 boxesWithinReach(const BoxNode& node, const BoxProbe& probe) const {
    Float4 above = kZero4 - static_cast<float>(high_), below = kZero4 + static_cast<float>(high_);
    for (int axis = 0; axis < 3; ++axis) {
      const auto n = static_cast<float>(normal_[axis]);
      const Float4 lo = n * node.lo[axis], hi = n * node.hi[axis];
      above += lo > hi ? lo : hi;
      below -= lo > hi ? hi : lo;
    }
    return (node.lo[0] <= node.hi[0]) & withinReach(boxDistances(node, probe), above, below);
  }

  /// Tests the discs of those children of a node that are rows.
  Test4 rowsWithinReach(const BoxNode& node, const BoxProbe& probe) const {
    const auto discOf = [&](std::size_t i) {
      return node.child[i] < 0 ? tree_.discs[static_cast<std::size_t>(node.row[i])] : RowDisc{};
    };
    const FourDiscs discs = fourOf(discOf(0), discOf(1), discOf(2), discOf(3));
    Float4 high{}, turn{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto n = static_cast<float>(normal_[axis]);
      high += n * (discs.center[axis] - probe.at[axis]);
      turn += n * discs.normal[axis];
    }
    const Float4 across2 = 1 - turn * turn;
    const Float4 extent = (turn > kZero4 ? turn : -turn) * discs.half +
                          squareRoots(across2 > kZero4 ? across2 : kZero4) * discs.radius * (1 + 1e-5F);
    return withinReach(rowDistances(discs, probe), extent + high, extent - high);
  }

  /// Tests four things. @param d2 [m^2] lower bound of the squared distance to the center of the triangle @param above
  /// [m] how high a thing is at most over the plane of the triangle, and how deep below it
  Test4 withinReach(const Float4& d2, const Float4& above, const Float4& below) const {
    constexpr auto kTwice = static_cast<float>(2 * (1 + 1e-5));
    const Float4 gap = squareRoots(d2) - static_cast<float>(radius_ * (1 + 1e-6));
    const Float4 gap2 = gap > kZero4 ? gap * gap : kZero4, rounding = kZero4 + rounding4_;
    return (gap2 <= (above + rounding) * (kTwice * static_cast<float>(whole_[0]))) |
           (gap2 <= (below + rounding) * (kTwice * static_cast<float>(whole_[1])));
  }

  void meetRow(const ElementRow& row) {
    for (std::uint32_t i = row.first; i < row.first + row.count; ++i) {
      const std::uint32_t other = tree_.elements[i].index();
      if (other == triangle_) continue;
      const Corners y = cornersOf(part_, other);
      const std::uint32_t common = commonCorners(part_.triangles[triangle_], part_.triangles[other]);
      if (common != 0)
        meetBeside(y, common);
      else if (!isClear(y))
        meetApart(y);
    }
  }

  /// Returns how far the corners y are from this triangle along an axis (unit vector), which ends at `end`.
  Three gapsAlong(const Vector3d& axis, const Vector3d& end, const Corners& y) const {
    Three gaps;
    for (std::size_t j = 0; j < 3; ++j) gaps[j] = axis.dot(y[j] - end) - rounding_;
    return gaps;
  }

  /// Returns the corner of this triangle that is farthest along an axis.
  const Vector3d& endAlong(const Vector3d& axis) const {
    std::size_t end = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (axis.dot(a_[k] - a_[end]) > 0) end = k;
    return a_[end];
  }

  /// Returns how high the corners y are over the plane of this triangle, rounded up on both sides.
  std::array<Three, 2> heightsOf(const Corners& y) const {
    std::array<Three, 2> heights;
    for (std::size_t j = 0; j < 3; ++j) {
      const double high = normal_.dot(y[j] - a_[0]);
      heights[0][j] = rounding_ + high;
      heights[1][j] = rounding_ - high;
    }
    return heights;
  }

  /// True if the balls certainly end before a triangle, seen along the line from center to center. This decides on most
  /// triangles. The axis is not a unit vector, which takes less time.
  bool isClear(const Corners& y) const {
    const Vector3d axis = y[0] + y[1] + y[2] - 3 * center_;
    const double end = std::max({axis.dot(a_[0]), axis.dot(a_[1]), axis.dot(a_[2])}) + rounding_ * axis.lpNorm<1>();
    const Three gaps{axis.dot(y[0]) - end, axis.dot(y[1]) - end, axis.dot(y[2]) - end};
    const double least = std::min({gaps[0], gaps[1], gaps[2]}), scale2 = axis.squaredNorm();
    const std::array<Three, 2> heights = heightsOf(y);
    bool clear = least > 0;
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t j = 0; j < 3; ++j)
        clear = clear && least * (2 * gaps[j] - least) >= 2 * scale2 * whole_[side] * heights[side][j];
    return clear;
  }

  /// Lets the balls end before a triangle that has no corner in common with this one.
  void meetApart(const Corners& y) {
    const Vector3d toward = (y[0] + y[1] + y[2] - 3 * center_).stableNormalized();
    const std::array<Three, 2> heights = heightsOf(y);
    std::array<double, 2> limit{0, 0};
    const auto tryAxis = [&](const Vector3d& axis, const Vector3d& end) {
      const Three gaps = gapsAlong(axis, end, y);
      for (std::size_t side = 0; side < 2; ++side) limit[side] = std::max(limit[side], largest(gaps, heights[side]));
    };
    tryAxis(toward, endAlong(toward));
    for (std::size_t k = 0; k < 3; ++k) tryAxis(out_[k], a_[k]);
    const Vector3d theirs = (y[1] - y[0]).cross(y[2] - y[0]).stableNormalized();
    for (const Vector3d& axis : {normal_, Vector3d(-normal_), theirs, Vector3d(-theirs)}) tryAxis(axis, endAlong(axis));
    for (std::size_t side = 0; side < 2; ++side) whole_[side] = std::min(whole_[side], limit[side]);
  }

  /// Returns the radius of the balls that end before a triangle. For its least gap l > 0, the square of a gap is at
  /// least l (2 gap - l). That is linear, and so is 2 r h: it suffices to compare them at the corners.
  static double largest(const Three& gaps, const Three& heights) {
    const double least = std::min({gaps[0], gaps[1], gaps[2]});
    double radius = kEndless;
    for (std::size_t j = 0; j < 3; ++j)
      if (heights[j] > 0) radius = std::min(radius, least > 0 ? least * (2 * gaps[j] - least) / (2 * heights[j]) : 0);
    return radius;
  }

  /// Lets the balls end before a triangle that has corners in common with this one, so that its least gap is 0. If x is
  /// d from an edge, a point y beyond that edge has |y - x|^2 >= (d + gap)^2 >= 4 d gap. So gap >= q h at the corners
  /// is enough for r <= 2 q d. Beyond a corner, the axis between those of its edges serves too, with the mean of both
  /// d.
  void meetBeside(const Corners& y, std::uint32_t common) {
    const std::array<Three, 2> heights = heightsOf(y);
    std::array<double, 2> best{0, 0};
    std::array<std::uint32_t, 2> by{7, 7};  // bit k for edge k
    const auto tryAxis = [&](const Vector3d& axis, std::size_t end, std::uint32_t edges) {
      const Three gaps = gapsAlong(axis, a_[end], y);
      for (std::size_t side = 0; side < 2; ++side)
        if (const double q = steepest(gaps, heights[side]); q > best[side]) best[side] = q, by[side] = edges;
    };
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t next = (k + 1) % 3, before = (k + 2) % 3;
      if (common == (1u << k | 1u << next)) tryAxis(out_[k], k, 1u << k);
      if (common != 1u << k) continue;
      tryAxis(out_[k], k, 1u << k);
      tryAxis(out_[before], k, 1u << before);
      tryAxis((out_[k] + out_[before]).stableNormalized(), k, 1u << k | 1u << before);
    }
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t k = 0; k < 3; ++k)
        if ((by[side] >> k & 1u) != 0) slope_[side][k] = std::min(slope_[side][k], 2 * best[side]);
  }

  /// Returns the greatest q for which gap >= q h at all corners, or 0 if there is none.
  double steepest(const Three& gaps, const Three& heights) const {
    double least = 0, most = kEndless;
    for (std::size_t j = 0; j < 3; ++j) {
      const bool common = std::abs(gaps[j] + rounding_) <= rounding_ && std::abs(heights[j] - rounding_) <= rounding_;
      if (common) continue;
      if (heights[j] >= 0)
        most = std::min(most, gaps[j] / heights[j]);
      else if (gaps[j] < 0)
        least = std::max(least, gaps[j] / heights[j]);
    }
    return most >= least ? most : 0;
  }

  const Part& part_;
  const BodyTree& tree_;
  std::uint32_t triangle_;
  Corners a_;
  Vector3d normal_, center_;
  std::array<Vector3d, 3> out_;  ///< axis out of each edge, in the plane
  Three height_{};               ///< [m] of the triangle over each edge
  double radius_ = 0;            ///< [m] no corner is farther from center_
  double high_;                  ///< [m] height of the plane over the origin of the tree
  double rounding_;              ///< [m] error of a gap or a height
  float rounding4_;              ///< [m] the same in single precision
  std::array<double, 2> whole_;  ///< [m] EmptyBalls::Side::whole
  std::array<Three, 2> slope_;   ///< EmptyBalls::Side::slope, for distances from the edges instead of coordinates
};

/// Finds out for which triangles aroundCorner() tells all that have a corner in common.
void findRings(Part& part, const BodyTree& tree) {
  std::vector<std::uint32_t> triangles_at(part.points.size());
  for (const Element element : tree.elements)
    for (const std::uint32_t point : part.triangles[element.index()].corner) ++triangles_at[point];
  for (const Element element : tree.elements) {
    const std::uint32_t t = element.index();
    bool all = true;
    for (std::uint32_t k = 0; k < 3; ++k)
      all = all && aroundCorner(part, t, k, [](std::uint32_t) {}) == triangles_at[part.triangles[t].corner[k]];
    part.balls[t].around = all ? 1 : 0;
  }
}

}  // namespace

void findEmptyBalls(Part& part, const BodyTree& tree) {
  part.balls.resize(part.triangles.size());
  for (const Element element : tree.elements)  // in this order, neighbours meet the same triangles
    part.balls[element.index()] = BallFinder(part, tree, element.index()).find();
  findRings(part, tree);
}

bool hasEmptyBalls(const Part& part, const BodyTree& tree) {
  constexpr std::size_t kSample = 256;  // triangles
  if (part.balls.size() != part.triangles.size()) return false;
  for (std::size_t i = 0; i < tree.elements.size(); i += tree.elements.size() / kSample + 1) {
    const std::uint32_t t = tree.elements[i].index();
    const auto known = std::bit_cast<Halves>(part.balls[t].sides);
    if (known != std::bit_cast<Halves>(BallFinder(part, tree, t).find().sides)) return false;
  }
  return true;
}

void findEmptyBalls(Part& part) {
  ModelOptions options;
  options.empty_balls = false;
  try {
    const Model model(Part(part), options);
    for (std::uint32_t b = 0; b < part.bodies.size(); ++b)
      if (!model.body(b).discs.empty()) findEmptyBalls(part, model.body(b));
  } catch (const std::invalid_argument&) {  // whoever feels the part is told why it cannot be searched
  }
}

}  // namespace hapticd::brep
