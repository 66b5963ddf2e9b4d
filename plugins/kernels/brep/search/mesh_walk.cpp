// SPDX-License-Identifier: MIT
/// The search for a probe that is followed over a mesh: it goes from triangle to triangle to the foot of the probe, and
/// an empty ball proves that foot. So it looks at a few triangles alone.
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "kernels/brep/model/empty_balls.hpp"
#include "kernels/brep/model/narrow_triangles.hpp"
#include "kernels/brep/search/search.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kInside = 3;
constexpr double kNearer = 1 - 1e-12;  ///< factor of a squared distance; a smaller difference counts as rounding error

/// A triangle of a mesh and its corners.
struct MeshTriangle {
  MeshTriangle(const Part& part, std::uint32_t index) noexcept
      : record(part.triangles[index]),
        a(vec(part.points[record.corner[0]])),
        ab(vec(part.points[record.corner[1]]) - a),
        ac(vec(part.points[record.corner[2]]) - a) {}

  Vector3d normal() const noexcept { return ab.cross(ac); }  ///< not of unit length

  /// Returns the edge beyond which p projects onto the plane of the triangle, or kInside. If there are two, it is the
  /// one with the least barycentric coordinate.
  std::uint32_t exitToward(const Vector3d& p) const noexcept {
    const Vector3d ap = p - a;
    const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm(), pb = ap.dot(ab), pc = ap.dot(ac);
    const double s = cc * pb - bc * pc, t = bb * pc - bc * pb;
    const double along[3] = {t, bb * cc - bc * bc - s - t, s};
    std::uint32_t k = along[1] < along[0] ? 1 : 0;
    if (along[2] < along[k]) k = 2;
    return along[k] < 0 ? k : kInside;
  }

  const Triangle& record;
  Vector3d a, ab, ac;
};

/// Keeps in `best` the nearest foot on the triangles around a corner of a triangle. Returns how many it looked at.
int lookAround(const Part& part, std::uint32_t triangle, std::uint32_t corner, const Vector3d& p, Hit& best) noexcept {
  int count = 0;
  aroundCorner(part, triangle, corner, [&](std::uint32_t other) {
    const Hit hit = footOn(part, other, p);
    if (hit.d2 < best.d2 * kNearer) best = hit;
    ++count;
  });
  return count;
}

}  // namespace

/// A walk from triangle to triangle.
class Search::MeshWalk {
 public:
  MeshWalk(const Model& model, const Vector3d& p, std::uint32_t from) noexcept
      : model_(model), p_(p), from_(from), at_(from) {}

  /// Returns true if hit() is certainly the nearest point. It looks at kMostSteps triangles, and at those around four
  /// corners in each of kMostArrivals.
  bool run() noexcept {
    for (int step = 0, arrivals = 0; step < kMostSteps; ++step) {
      __builtin_prefetch(&model_.emptyBalls()[at_]);
      const MeshTriangle triangle(model_.part(), at_);
      for (const std::uint32_t next : triangle.record.across)
        if (next != kNone) __builtin_prefetch(&model_.part().triangles[next / 4]);
      const std::uint32_t exit = triangle.exitToward(p_);
      ++looked_at_;
      const std::uint32_t code = exit == kInside ? kNone : triangle.record.across[exit];
      const bool stays_on_edge = exit == entered_ && code / 4 != from_;  // else the triangle of the last tick keeps it
      if (exit == kInside || stays_on_edge) {
        if (arrive(triangle, exit) || ++arrivals == kMostArrivals) return proved_;
        continue;
      }
      if (code == kNone) return false;
      at_ = code / 4;
      entered_ = code % 4;
    }
    return false;
  }

  const Hit& hit() const noexcept { return hit_; }
  int lookedAt() const noexcept { return looked_at_; }

 private:
  static constexpr int kMostSteps = 16, kMostArrivals = 3;

  /// Ends the walk in the interior of a triangle, or on an edge that it has crossed to and fro. Returns false if a
  /// triangle beside is nearer: the walk goes on there.
  bool arrive(const MeshTriangle& triangle, std::uint32_t exit) noexcept {
    hit_ = footOn(model_.part(), at_, p_);
    const auto region = static_cast<TriangleRegion>(hit_.region);
    const std::uint32_t expected = exit == kInside ? 0 : exit + 1;
    if (region != static_cast<TriangleRegion>(expected)) return true;
    const EmptyBalls& balls = model_.emptyBalls()[at_];
    const bool back = triangle.normal().dot(p_ - hit_.point) < 0;
    if (exit == kInside && isLess(emptyRadius(balls, hit_, back))) return proved_ = true;
    if (balls.around == 0 || !isLess(wholeRadius(balls, back))) return true;
    Hit best = hit_;
    if (exit != kInside) {
      const std::uint32_t code = triangle.record.across[exit];  // its edge begins and ends at corners of both
      if (!isProvedBeyond(triangle, code / 4)) return true;
      looked_at_ += lookAround(model_.part(), code / 4, (code % 4 + 2) % 3, p_, best);
    }
    for (std::uint32_t k = 0; k < 3; ++k) looked_at_ += lookAround(model_.part(), at_, k, p_, best);
    if (best.element == hit_.element) return proved_ = true;
    at_ = best.element.index();
    entered_ = kInside;
    return false;
  }

  bool isLess(double radius) const noexcept { return hit_.d2 < radius * radius; }

  /// True if a ball about the probe that touches the edge between two triangles holds nothing but triangles beside
  /// them. The way m from the edge to the probe is a sum of both unit normals, with factors of at least 0. A point in
  /// the ball is then in a ball that touches one of the triangles there, with a radius that is larger by the sum of
  /// these factors, which is at most sqrt(2 / (1 + c)) for normals with the cosine c.
  bool isProvedBeyond(const MeshTriangle& triangle, std::uint32_t beyond) const noexcept {
    constexpr double kLeastCosine = 0.5, kLarger = 1.16;  // > sqrt(2 / 1.5)
    const MeshTriangle other(model_.part(), beyond);
    const Vector3d way = p_ - hit_.point, here = triangle.normal(), there = other.normal();
    const bool back = way.dot(here) < 0, other_back = way.dot(there) < 0;
    const double cosine = here.dot(there) * (back == other_back ? 1 : -1);
    if (!(cosine > kLeastCosine * here.norm() * there.norm())) return false;
    const EmptyBalls &balls = model_.emptyBalls()[at_], &others = model_.emptyBalls()[beyond];
    return others.around != 0 && isLess(std::min(wholeRadius(balls, back), wholeRadius(others, other_back)) / kLarger);
  }

  const Model& model_;
  const Vector3d& p_;
  Hit hit_;
  std::uint32_t from_, at_, entered_ = kInside;
  int looked_at_ = 0;
  bool proved_ = false;
};

/// Returns true if a walk over the mesh has found the nearest point; last_ is then the result of this tick.
bool Search::walkMesh(const Vector3d& p, const SearchBudget& budget) noexcept {
  if (model_.emptyBalls().empty() || !last_.found() || budget.elements <= NearTriangles::kMostRows * BodyTree::kMeshRow)
    return false;
  const Vector3d p_body = model_.placements()[0].toBody(p);
  MeshWalk walk(model_, p_body, last_.hit.element.index());
  if (!walk.run()) return false;
  last_.hit = walk.hit();
  last_.others = std::sqrt(last_.hit.d2) * (1 - kRounding);
  last_.open2 = std::numeric_limits<double>::infinity();
  last_.proved = true;
  last_.exhausted = false;
  last_.nodes = 0;
  last_.elements = walk.lookedAt();
  last_p_ = p;
  return true;
}

}  // namespace hapticd::brep
