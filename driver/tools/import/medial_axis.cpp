// SPDX-License-Identifier: MIT
#include "import/medial_axis.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "import/nearest_points.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kMostShrinks = 50;               ///< largest number of steps in which a ball shrinks
constexpr double kShrunk = 1e-9;               ///< relative change of a radius below which a ball no longer shrinks
constexpr std::size_t kMostCandidates = 6000;  ///< largest number of balls from which the spheres are chosen
constexpr std::size_t kMostCovered = 12000;    ///< largest number of samples that the spheres must cover
constexpr int kChecks = 8;                     ///< spheres that are checked along an edge
constexpr double kFlatCosine = 0.94;           ///< cosine of 20 degrees: flatter edges belong to a smooth surface

struct Ball {
  Vector3d center;
  double radius;
};

/// Returns the ball that touches the surface at sample i from inside and contains no other sample. Samples that are
/// seen from its centre at less than `least_angle` from sample i do not count, because they are the surface around
/// sample i, with the ripples of its triangles.
Ball shrink(const SurfaceSamples& samples, const NearestPoints& nearest, uint32_t i, double start, double least_angle) {
  const Vector3d &p = samples.points[i], &n = samples.normals[i];
  const NearestPoints::HalfSpaceFilter opposite{p, -n, std::sin(least_angle / 2)};
  Ball ball{p - start * n, start};
  for (int k = 0; k < kMostShrinks; ++k) {
    // Points outside the ball are not asked for, because on a flat face thousands of points are nearly as near.
    const uint32_t j = nearest.nearest(ball.center, &opposite, ball.radius * (1 - kShrunk));
    if (j == UINT32_MAX) break;
    const Vector3d between = p - samples.points[j];
    const double along = n.dot(between);
    if (!(along > 0)) break;
    const double radius = between.squaredNorm() / (2 * along);
    const bool done = radius > ball.radius * (1 - kShrunk);
    ball = {p - radius * n, radius};
    if (done) break;
  }
  return ball;
}

/// Returns every k-th element, so that at most `most` are left.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, std::size_t most) {
  const std::size_t stride = (all.size() + most - 1) / most;
  std::vector<T> some;
  for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(stride, 1)) some.push_back(all[i]);
  return some;
}

/// Chooses balls: repeatedly takes the ball that covers most of the samples that are not covered yet.
std::vector<Ball> cover(const std::vector<Ball>& candidates, const std::vector<Vector3d>& points,
                        const MedialOptions& options, double& covered) {
  std::vector<std::vector<uint32_t>> covers(candidates.size());
  for (std::size_t b = 0; b < candidates.size(); ++b) {
    const double reach = candidates[b].radius + options.tolerance;
    for (uint32_t i = 0; i < points.size(); ++i)
      if ((points[i] - candidates[b].center).squaredNorm() <= reach * reach) covers[b].push_back(i);
  }
  std::vector<bool> bare(points.size(), true);
  std::size_t left = points.size();
  std::vector<Ball> kept;
  const auto gain = [&](std::size_t b) {
    return std::count_if(covers[b].begin(), covers[b].end(), [&](uint32_t i) { return bare[i]; });
  };
  // The number of uncovered samples that a ball covers never grows, so a ball whose old count is not the greatest needs
  // no new count.
  std::vector<std::pair<std::ptrdiff_t, std::size_t>> heap;
  for (std::size_t b = 0; b < candidates.size(); ++b) heap.emplace_back(gain(b), b);
  std::make_heap(heap.begin(), heap.end());
  while (!heap.empty() && static_cast<int>(kept.size()) < options.most_spheres && left > 0) {
    std::pop_heap(heap.begin(), heap.end());
    const auto [old, b] = heap.back();
    heap.pop_back();
    const std::ptrdiff_t now = gain(b);
    if (now == 0) continue;
    if (now < old && !heap.empty() && now < heap.front().first) {
      heap.emplace_back(now, b);
      std::push_heap(heap.begin(), heap.end());
      continue;
    }
    kept.push_back(candidates[b]);
    for (const uint32_t i : covers[b]) {
      left -= bare[i] ? 1 : 0;
      bare[i] = false;
    }
  }
  covered = 1 - static_cast<double>(left) / static_cast<double>(points.size());
  return kept;
}

/// Returns true if a sphere extends out of the body by more than the tolerance.
bool standsOut(const Vector3d& center, double radius, const SurfaceSamples& samples, const NearestPoints& nearest,
               double tolerance) {
  const uint32_t i = nearest.nearest(center);
  const Vector3d out = center - samples.points[i];
  return samples.normals[i].dot(out) > 0 || out.norm() < radius - tolerance - samples.spacing;
}

std::vector<Ball> innerBalls(const SurfaceSamples& samples, const NearestPoints& nearest, const MedialOptions& options,
                             ProgressLine& progress) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : samples.points) box.extend(p);
  const double size = box.diagonal().norm(), least_angle = options.least_angle * M_PI / 180;
  std::vector<Ball> balls;
  for (uint32_t i = 0; i < samples.points.size(); ++i) {
    progress.show("shrinking a ball at each of the points", i, samples.points.size());
    const Ball ball = shrink(samples, nearest, i, size, least_angle);
    if (ball.radius < size / 2 && box.contains(ball.center) &&
        !standsOut(ball.center, ball.radius, samples, nearest, options.tolerance / 2))
      balls.push_back(ball);
  }
  return balls;
}

/// Returns the indices of the three spheres nearest to a point, the nearest first; -1 where there are fewer spheres.
std::array<int, 3> threeNearest(const std::vector<Ball>& kept, const Vector3d& p) {
  std::array<int, 3> best{-1, -1, -1};
  std::array<double, 3> distance{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  for (std::size_t i = 0; i < kept.size(); ++i) {
    double d = (kept[i].center - p).squaredNorm();
    int index = static_cast<int>(i);
    for (std::size_t k = 0; k < 3; ++k)
      if (d < distance[k]) {
        std::swap(d, distance[k]);
        std::swap(index, best[k]);
      }
  }
  return best;
}

/// Finds which spheres are connected.
class Parts {
 public:
  explicit Parts(std::size_t count) : part_(count), count_(static_cast<int>(count)) {
    std::iota(part_.begin(), part_.end(), 0U);
  }
  bool joined(int a, int b) { return root(a) == root(b); }
  void join(int a, int b) {
    count_ -= joined(a, b) ? 0 : 1;
    part_[root(a)] = root(b);
  }
  int count() const { return count_; }

 private:
  std::size_t root(int a) {
    auto i = static_cast<std::size_t>(a);
    while (part_[i] != i) i = part_[i] = part_[part_[i]];
    return i;
  }
  std::vector<std::size_t> part_;
  int count_;
};

/// Finds which edges and triangles of balls stay inside the body.
class InsideTest {
 public:
  InsideTest(const std::vector<Ball>& kept, const SurfaceSamples& samples, const NearestPoints& nearest,
             double tolerance)
      : kept_(kept), samples_(samples), nearest_(nearest), tolerance_(tolerance) {}

  bool edge(int a, int b) const {
    bool good = true;
    for (int k = 1; good && k < kChecks; ++k) good = point({{a, 1 - k / double(kChecks)}, {b, k / double(kChecks)}});
    return good;
  }

  bool triangle(const std::array<int, 3>& t) const {
    bool good = point({{t[0], 1 / 3.0}, {t[1], 1 / 3.0}, {t[2], 1 / 3.0}});
    for (std::size_t k = 0; good && k < 3; ++k)
      good = point({{t[k], 2 / 3.0}, {t[(k + 1) % 3], 1 / 6.0}, {t[(k + 2) % 3], 1 / 6.0}});
    return good;
  }

 private:
  bool point(std::initializer_list<std::pair<int, double>> parts) const {
    Vector3d center = Vector3d::Zero();
    double radius = 0;
    for (const auto& [i, weight] : parts) {
      center += weight * kept_[static_cast<std::size_t>(i)].center;
      radius += weight * kept_[static_cast<std::size_t>(i)].radius;
    }
    return !standsOut(center, radius, samples_, nearest_, tolerance_);
  }

  const std::vector<Ball>& kept_;
  const SurfaceSamples& samples_;
  const NearestPoints& nearest_;
  double tolerance_;
};

using Edges = std::set<std::array<int, 2>>;

/// Joins parts that are still separate by the shortest edges inside the body, in case the samples were too few to find
/// them.
void bridgeGaps(const std::vector<Ball>& kept, const InsideTest& sound, Parts& parts, Edges& edges) {
  std::vector<std::pair<double, std::array<int, 2>>> gaps;
  const int count = static_cast<int>(kept.size());
  for (int a = 0; a < count && parts.count() > 1; ++a)
    for (int b = a + 1; b < count; ++b)
      if (!parts.joined(a, b))
        gaps.push_back(
            {(kept[static_cast<std::size_t>(a)].center - kept[static_cast<std::size_t>(b)].center).norm(), {a, b}});
  std::sort(gaps.begin(), gaps.end());
  for (const auto& [length, e] : gaps) {
    if (parts.count() == 1) break;
    if (parts.joined(e[0], e[1]) || !sound.edge(e[0], e[1])) continue;
    parts.join(e[0], e[1]);
    edges.insert(e);
  }
}

/// Adds edges and triangles between the balls nearest to the same witness, if they stay inside the body.
void join(const std::vector<Ball>& kept, const std::vector<Ball>& witnesses, const InsideTest& sound,
          MedialAxis& axis) {
  Edges edges, refused;
  std::set<std::array<int, 3>> triangles;
  for (const Ball& witness : witnesses) {
    auto near = threeNearest(kept, witness.center);
    if (near[1] < 0) continue;
    const std::array<int, 2> edge{std::min(near[0], near[1]), std::max(near[0], near[1])};
    if (!edges.contains(edge) && !refused.contains(edge)) (sound.edge(edge[0], edge[1]) ? edges : refused).insert(edge);
    if (near[2] < 0) continue;
    std::sort(near.begin(), near.end());
    triangles.insert(near);
  }
  for (const auto& t : triangles) {
    const bool framed = edges.contains({t[0], t[1]}) && edges.contains({t[0], t[2]}) && edges.contains({t[1], t[2]});
    if (framed && sound.triangle(t)) axis.triangles.push_back(t);
  }
  Parts parts(kept.size());
  for (const auto& e : edges) parts.join(e[0], e[1]);
  bridgeGaps(kept, sound, parts, edges);
  axis.parts = parts.count();
  axis.edges.assign(edges.begin(), edges.end());
}

/// Returns the normal at each corner of each triangle: the mean, weighted by angle, of the normals of the triangles
/// around the corner that no sharp edge separates from this triangle. With the normal of the flat triangle alone, the
/// centre of a ball between two feet 60 degrees apart would have an error of three times the angle between facets,
/// times its radius.
std::vector<std::array<Vector3d, 3>> cornerNormals(const Triangles& mesh) {
  struct Fan {
    Vector3d normal;
    double angle;
  };
  const auto fanOf = [&mesh](const std::array<uint32_t, 3>& c, std::size_t k) {
    const Vector3d &p = mesh.points[c[k]], a = mesh.points[c[(k + 1) % 3]] - p, b = mesh.points[c[(k + 2) % 3]] - p;
    const Vector3d normal = a.cross(b);
    return Fan{normal.normalized(), std::atan2(normal.norm(), a.dot(b))};
  };
  std::vector<std::vector<Fan>> about(mesh.points.size());
  for (const auto& c : mesh.corners)
    for (std::size_t k = 0; k < 3; ++k) about[c[k]].push_back(fanOf(c, k));
  std::vector<std::array<Vector3d, 3>> normals;
  for (const auto& c : mesh.corners) {
    std::array<Vector3d, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d own = fanOf(c, k).normal;
      corner[k] = 1e-9 * own;
      for (const Fan& fan : about[c[k]])
        if (fan.normal.dot(own) > kFlatCosine) corner[k] += fan.angle * fan.normal;
      corner[k].normalize();
    }
    normals.push_back(corner);
  }
  return normals;
}

}  // namespace

SurfaceSamples sampleSurface(const Triangles& mesh, std::size_t count) {
  constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;  // steps of an even sequence in a square
  SurfaceSamples samples;
  double area = 0;
  std::vector<double> until;
  for (const auto& c : mesh.corners) {
    area += (mesh.points[c[1]] - mesh.points[c[0]]).cross(mesh.points[c[2]] - mesh.points[c[0]]).norm() / 2;
    until.push_back(area);
  }
  if (!(area > 0)) return samples;
  samples.spacing = std::sqrt(area / static_cast<double>(count));
  const auto normals = cornerNormals(mesh);
  std::size_t t = 0;
  double r = .5, s = .5;
  for (std::size_t k = 0; k < count; ++k) {
    while (t + 1 < until.size() && until[t] < area * (static_cast<double>(k) + .5) / static_cast<double>(count)) ++t;
    const auto& c = mesh.corners[t];
    const Vector3d a = mesh.points[c[1]] - mesh.points[c[0]], b = mesh.points[c[2]] - mesh.points[c[0]];
    r = std::fmod(r + kFirst, 1);
    s = std::fmod(s + kSecond, 1);
    const bool beyond = r + s > 1;
    const double x = beyond ? 1 - r : r, y = beyond ? 1 - s : s;
    samples.points.push_back(mesh.points[c[0]] + x * a + y * b);
    const Vector3d normal = (1 - x - y) * normals[t][0] + x * normals[t][1] + y * normals[t][2];
    samples.normals.push_back(normal.normalized());
  }
  return samples;
}

Result<MedialAxis> medialAxis(const SurfaceSamples& samples, const MedialOptions& options, ProgressLine& progress) {
  if (samples.points.empty()) return Error{"the triangles have no area, so there is no surface"};
  progress.show(std::to_string(samples.points.size()) + " points on the surface");
  const NearestPoints nearest(samples.points);
  const std::vector<Ball> balls = innerBalls(samples, nearest, options, progress);
  if (balls.empty())
    return Error{"the body has no medial axis: no ball inside touches the surface at two places that are " +
                 std::to_string(std::lround(options.least_angle)) +
                 " degrees apart\n  fix: give a smaller --angle (default 60), or more --samples if walls are thin"};
  progress.show(std::to_string(balls.size()) + " balls on the medial axis; choosing the fewest that cover the surface");
  MedialAxis axis;
  const std::vector<Ball> kept =
      cover(thinned(balls, kMostCandidates), thinned(samples.points, kMostCovered), options, axis.covered);
  progress.show(std::to_string(kept.size()) + " spheres; joining them");
  for (const Ball& ball : kept)
    axis.spheres.emplace_back(ball.center.x(), ball.center.y(), ball.center.z(), ball.radius);
  join(kept, balls, InsideTest(kept, samples, nearest, options.tolerance), axis);
  return axis;
}

}  // namespace hapticd::importing
