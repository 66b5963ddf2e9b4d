// SPDX-License-Identifier: MIT
/// Tests the empty balls of meshes, and the walks that they prove, by brute force over all triangles.
#include "kernels/brep/model/empty_balls.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "kernels/brep/model/narrow_triangles.hpp"
#include "kernels/brep/search/search.hpp"
#include "kernels/part/file.hpp"
#include "sample_meshes.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-16;  ///< [m] of a coordinate

bool touch(const Triangle& a, const Triangle& b) {
  return std::any_of(a.corner.begin(), a.corner.end(),
                     [&](std::uint32_t i) { return std::find(b.corner.begin(), b.corner.end(), i) != b.corner.end(); });
}

/// Returns the least distance from p to the triangles for which use(index) is true.
template <class Use>
double leastDistance(const Part& part, const Vector3d& p, const Use& use) {
  double least2 = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < part.triangles.size(); ++t)
    if (use(t)) least2 = std::min(least2, footOn(part, t, p).d2);
  return std::sqrt(least2);
}

double leastDistance(const Part& part, const Vector3d& p) {
  return leastDistance(part, p, [](std::uint32_t) { return true; });
}

/// Touches triangles with balls that are told to be empty. Returns the share of balls with a radius of more than zero.
double touchWithBalls(const Part& part, unsigned seed) {
  constexpr int kBalls = 2000;
  const Model model{Part(part)};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  int large = 0;
  for (int i = 0; i < kBalls; ++i) {
    const auto t = static_cast<std::uint32_t>(random() % part.triangles.size());
    const auto& corner = part.triangles[t].corner;
    const Vector3d a = vec(part.points[corner[0]]), ab = vec(part.points[corner[1]]) - a,
                   ac = vec(part.points[corner[2]]) - a;
    Hit foot;
    foot.u = std::pow(share(random), i % 4 + 1), foot.v = (1 - foot.u) * std::pow(share(random), i % 3 + 1);
    const bool back = random() % 2 == 0;
    const EmptyBalls& balls = model.emptyBalls()[t];
    const Vector3d x = a + foot.u * ab + foot.v * ac, n = (back ? -1 : 1) * ab.cross(ac).normalized();
    const double radius = emptyRadius(balls, foot, back), whole = wholeRadius(balls, back);
    EXPECT_LE(radius, whole);
    large += radius > 0;
    if (radius > 0) {
      EXPECT_GE(leastDistance(part, x + radius * n), radius * (1 - 1e-9) - kRounding)
          << t << " from " << (back ? "behind" : "front");
    }
    if (whole > 0) {
      const auto apart = [&](std::uint32_t other) { return !touch(part.triangles[t], part.triangles[other]); };
      EXPECT_GE(leastDistance(part, x + whole * n, apart), whole * (1 - 1e-9) - kRounding)
          << t << (back ? " behind" : " front");
    }
  }
  return static_cast<double>(large) / kBalls;
}

/// Returns two wavy sheets, one above the other. @param height [m] amplitude of the waves @param gap [m] between them
Part twoSheets(std::uint32_t n, double height, double gap) {
  Part part = samples::sheet(n, height);
  const auto points = static_cast<std::uint32_t>(part.points.size());
  const std::vector<Triangle> first = part.triangles;
  for (std::uint32_t i = 0; i < points; ++i) {
    Vector p = part.points[i];
    p[2] += gap;
    part.points.push_back(p);
  }
  for (Triangle t : first) {
    for (std::uint32_t& corner : t.corner) corner += points;
    part.triangles.push_back(t);
  }
  part.bodies[0].point_count *= 2;
  part.bodies[0].triangle_count *= 2;
  return part;
}

/// Returns a mesh whose corners were moved at random. @param share of the mean length of an edge
Part jagged(Part part, double share, std::mt19937& random) {
  std::uniform_real_distribution<double> away(-1, 1);
  double length = 0;
  for (const Triangle& t : part.triangles)
    length += (vec(part.points[t.corner[0]]) - vec(part.points[t.corner[1]])).norm();
  length /= static_cast<double>(part.triangles.size());
  for (Vector& p : part.points)
    for (double& x : p) x += share * length * away(random);
  return part;
}

TEST(EmptyBalls, AreEmpty) {
  std::mt19937 random(5);
  EXPECT_GT(touchWithBalls(samples::bumpyBall(4000), 1), 0.99);
  EXPECT_GT(touchWithBalls(samples::sheet(40, 0.004), 2), 0.99);
  EXPECT_GT(touchWithBalls(samples::sheet(40, 0.02), 3), 0.8);  // steep waves of a few triangles each
  EXPECT_GT(touchWithBalls(samples::sheet(40, 0), 4), 0.99);
  EXPECT_GT(touchWithBalls(samples::partOf(samples::unitBall()), 5), 0.99);
  EXPECT_GT(touchWithBalls(twoSheets(30, 0.002, 1e-3), 6), 0.9);
  EXPECT_GT(touchWithBalls(samples::scatteredTriangles(random), 7), 0.5);
  for (unsigned seed = 8; seed < 14; ++seed)
    EXPECT_GT(touchWithBalls(jagged(samples::partOf(samples::unitBall()), 0.05 * seed, random), seed), 0.3);
}

/// A wall that is thin beside its triangles has small balls, and large ones outside.
TEST(EmptyBalls, EndAtTheNextSheet) {
  const Model model(twoSheets(10, 0, 1e-4));
  const EmptyBalls& lower = model.emptyBalls()[100];
  EXPECT_LT(wholeRadius(lower, false), 0.51e-4);
  EXPECT_GT(wholeRadius(lower, false), 0.2e-4);
  EXPECT_GT(wholeRadius(lower, true), 1e-3);
}

/// Two triangles in one place, and triangles that go through each other, have no empty balls.
TEST(EmptyBalls, AreNoneWhereTrianglesMeet) {
  const std::vector<Vector> points{
      {0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.002, -0.005}, {0.002, 0.003, 0.005}, {0.003, 0.002, 0.005}};
  const Model twice(samples::meshOf(points, {{0, 1, 2}, {0, 2, 1}}));
  const Model crossing(samples::meshOf(points, {{0, 1, 2}, {3, 4, 5}}));
  Hit middle;
  middle.u = middle.v = 0.3;
  for (const bool back : {false, true}) {
    EXPECT_EQ(emptyRadius(twice.emptyBalls()[0], middle, back), 0);
    EXPECT_EQ(emptyRadius(crossing.emptyBalls()[0], middle, back), 0);
  }
}

TEST(EmptyBalls, KnowWhereACornerHasMoreThanOneRing) {
  const auto allAround = [](const Part& part) {
    const Model model{Part(part)};
    return std::count_if(model.emptyBalls().begin(), model.emptyBalls().end(),
                         [](const auto& b) { return b.around != 0; });
  };
  const Part ball = samples::partOf(samples::unitBall());
  EXPECT_EQ(allAround(ball), 512);
  EXPECT_EQ(allAround(samples::sheet(8, 0)), 0);  // no neighbours are known
  EXPECT_EQ(allAround(samples::joined(samples::sheet(8, 0))), 6 * 6 * 2);
  Part touching = ball;  // a triangle that has one corner in common with the ball
  touching.points.insert(touching.points.end(), {{3, 0, 0}, {3, 1, 0}});
  const std::uint32_t corner = ball.triangles[0].corner[0];
  const auto count = static_cast<std::uint32_t>(ball.points.size());
  touching.triangles.push_back({{corner, count, count + 1}, {kNone, kNone, kNone}});
  touching.bodies[0].point_count += 2;
  touching.bodies[0].triangle_count += 1;
  EXPECT_LT(allAround(touching), 512);
  EXPECT_GT(allAround(touching), 512 - 32);
}

std::vector<EmptyBalls> ballsOf(const Part& part) {
  return Model(Part(part)).emptyBalls();
}

bool areSame(const std::vector<EmptyBalls>& a, const std::vector<EmptyBalls>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

/// A part file keeps the balls that an import finds. If they are not those of its triangles, they are found again.
TEST(EmptyBalls, AreKeptInAFile) {
  const Part part = samples::bumpyBall(4000);
  Part with_balls = part;
  findEmptyBalls(with_balls);
  const std::string bytes = writePart(with_balls);
  Part read = readPart(std::as_bytes(std::span(bytes)), "ball.hpart");
  const std::vector<EmptyBalls> truth = ballsOf(part);
  EXPECT_EQ(truth.size(), part.triangles.size());
  EXPECT_TRUE(areSame(read.balls, truth));
  read.balls[17].around = 0;  // no sample sees this one, so it shows that they are taken from the file
  EXPECT_TRUE(areSame(ballsOf(read), read.balls));
  for (EmptyBalls& balls : read.balls) balls.sides[1].whole += 1;
  EXPECT_TRUE(areSame(ballsOf(read), truth));
  read.balls.pop_back();
  EXPECT_TRUE(areSame(ballsOf(read), truth));
}

/// To find those of a large mesh would take who loads it seconds: it is felt without, and says so.
TEST(EmptyBalls, OfALargeMeshAreFoundByItsImport) {
  Part part = samples::sheet(230, 0.001);
  ASSERT_GT(part.triangles.size(), 100'000u);
  const Model without{Part(part)};
  EXPECT_TRUE(without.emptyBalls().empty());
  ASSERT_EQ(without.warnings().size(), 1u);
  EXPECT_NE(without.warnings()[0].find("import the mesh again"), std::string::npos);
  findEmptyBalls(part);
  const Model with_balls{Part(part)};
  EXPECT_EQ(with_balls.emptyBalls().size(), part.triangles.size());
  EXPECT_TRUE(with_balls.warnings().empty());
}

/// An assembly has none: another body may be nearer. Its file may have them, for a model of one of its instances.
TEST(EmptyBalls, AreOfOneInstance) {
  Part part = samples::bumpyBall(1000);
  part.instances.push_back(part.instances[0]);
  part.names = {"here", "there"};
  part.instances[0].name = 0;
  part.instances[1].name = 1;
  part.instances[1].pose[3] = 0.2;
  findEmptyBalls(part);
  EXPECT_EQ(part.balls.size(), part.triangles.size());
  EXPECT_TRUE(ballsOf(part).empty());
  ModelOptions options;
  options.instance = "there";
  EXPECT_TRUE(areSame(Model(Part(part), options).emptyBalls(), part.balls));
}

/// Walks over a mesh in steps of up to some triangles, and compares each foot with all triangles. Returns the share of
/// the ticks that needed no search.
double walk(const Part& part, double height, double step, unsigned seed) {
  const Model model{Part(part)};
  Search search(model);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  constexpr int kTicks = 2000;
  int walked = 0;
  Vector3d p = vec(part.points[part.triangles[7].corner[0]]), way = Vector3d::UnitX();
  for (int i = 0; i < kTicks; ++i) {
    const Nearest& found = search.nearest(p);
    const double truth = leastDistance(part, p);
    EXPECT_TRUE(found.proved) << i;
    EXPECT_NEAR(found.distance(), truth, 1e-15 + 1e-12 * truth) << i;
    EXPECT_NEAR((found.hit.point - p).norm(), found.distance(), 1e-15) << i;
    walked += found.nodes == 0;
    const auto& corner = part.triangles[found.hit.element.index()].corner;
    const Vector3d n = (vec(part.points[corner[1]]) - vec(part.points[corner[0]]))
                           .cross(vec(part.points[corner[2]]) - vec(part.points[corner[0]]))
                           .normalized();
    way += 0.2 * Vector3d(normal(random), normal(random), normal(random));
    way = (way - way.dot(n) * n).normalized();
    p = found.hit.point + height * std::sin(0.05 * i) * n + step * way;
  }
  return static_cast<double>(walked) / kTicks;
}

TEST(MeshWalk, FindsTheNearestPointWithoutASearch) {
  const Part ball = samples::bumpyBall(4000);  // triangles of 5 mm
  EXPECT_GT(walk(ball, 0.001, 2e-4, 1), 0.9);
  EXPECT_GT(walk(ball, 0.001, 2e-3, 2), 0.9);
  EXPECT_GT(walk(ball, 0.001, 2e-2, 3), 0.8);
  EXPECT_LT(walk(ball, 0.2, 2e-3, 4), 0.9);  // as far as balls are not known
  EXPECT_GT(walk(samples::partOf(samples::unitBall()), 0.1, 0.05, 5), 0.97);
  EXPECT_GT(walk(samples::joined(samples::sheet(40, 0.004)), 0.0005, 1e-3, 6), 0.3);
  EXPECT_GE(walk(samples::joined(twoSheets(30, 0.002, 1e-3)), 0.0002, 1e-3, 7), 0);
  EXPECT_GE(walk(samples::joined(samples::sheet(40, 0.02)), 0.001, 1e-3, 8), 0);
}

/// Probes above edges, from above and below, where the last tick was beside: no foot that is proved is wrong. Returns
/// how many feet on edges were found without a search.
int probeEdges(const Part& part, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  const Model model{Part(part)};
  Search search(model);
  int on_edges = 0;
  for (int i = 0; i < 300; ++i) {
    const Triangle& t = part.triangles[random() % part.triangles.size()];
    const std::size_t k = random() % 3;
    if (t.across[k] == kNone) continue;
    const auto normal = [&](const Triangle& of) {
      const Vector3d a = vec(part.points[of.corner[0]]);
      return (vec(part.points[of.corner[1]]) - a).cross(vec(part.points[of.corner[2]]) - a).stableNormalized();
    };
    const Vector3d from = vec(part.points[t.corner[k]]), way = vec(part.points[t.corner[(k + 1) % 3]]) - from;
    const double turn = share(random), far = 2 * std::pow(share(random), 3) * way.norm() * (random() % 2 == 0 ? 1 : -1);
    const Vector3d n = turn * normal(t) + (1 - turn) * normal(part.triangles[t.across[k] / 4]);
    const Vector3d p = from + share(random) * way + far * n;
    search.reset();
    search.nearest(p + 0.1 * way.norm() * Vector3d(share(random), share(random), share(random)));
    const Nearest& found = search.nearest(p);
    const double truth = leastDistance(part, p);
    if (found.proved) {
      EXPECT_NEAR(found.distance(), truth, 1e-12 * (1 + truth)) << i << ", " << found.nodes << " nodes";
    }
    on_edges += found.nodes == 0 && found.hit.region != 0;
  }
  return on_edges;
}

TEST(MeshWalk, ProvesNoWrongFootOnAJaggedMesh) {
  std::mt19937 random(31);
  int on_edges = 0;
  for (int i = 0; i < 20; ++i) {
    const double share = 0.03 * i;
    on_edges += probeEdges(jagged(samples::partOf(samples::unitBall()), share, random), random);
    on_edges += probeEdges(jagged(samples::joined(samples::sheet(12, 0.01)), share, random), random);
    on_edges += probeEdges(jagged(samples::joined(twoSheets(8, 0, 0.005)), share, random), random);
  }
  EXPECT_GT(on_edges, 300);
}

/// A roof of two slopes, and a small triangle that is nearer to a probe above the ridge. The balls that touch the first
/// slope end before nothing, since this triangle is below that slope's plane.
TEST(MeshWalk, LooksAtBothSidesOfARidge) {
  const double rise = std::sin(0.5), run = std::cos(0.5);
  std::vector<Vector> points{{0, 0, 0}, {0, 1, 0}, {-run, 0.5, -rise}, {run, 0.5, -rise}};
  std::vector<std::array<std::uint32_t, 3>> corners{{0, 1, 2}, {1, 0, 3}, {0, 2, 3}, {2, 1, 3}};
  const Vector3d p(0, 0.5, 0.1);
  for (const bool attached : {false, true}) {  // to the far corner of the second slope
    std::vector<Vector> all = points;
    std::vector<std::array<std::uint32_t, 3>> mesh = corners;
    all.insert(all.end(), {{0.045, 0.5, 0.023}, {0.06, 0.51, 0.02}, {0.06, 0.49, 0.02}});
    mesh.push_back({4, 5, attached ? 3u : 6u});
    const Part part = samples::joined(samples::meshOf(all, mesh));
    const Model model{Part(part)};
    EXPECT_EQ(model.emptyBalls()[0].around, 1);
    EXPECT_GT(wholeRadius(model.emptyBalls()[0], false), 0.11);
    Search search(model);
    const Hit ridge = footOn(part, 0, p);
    EXPECT_LT(leastDistance(part, p), 0.95 * std::sqrt(ridge.d2));
    for (const double x : {-0.08, 0.08}) {
      search.reset();
      search.nearest(Vector3d(x, 0.5, -0.02));
      EXPECT_NEAR(search.nearest(p).distance(), leastDistance(part, p), 1e-15) << attached;
    }
  }
}

/// A walk needs the neighbours of triangles. Without them it stays on its triangle.
TEST(MeshWalk, IsRightWithoutNeighbours) {
  EXPECT_GT(walk(samples::sheet(40, 0.004), 0.0005, 1e-4, 9), 0.5);
}

/// To find the balls of a triangle has a bound: needles side by side, as on a finely divided cylinder, are all near
/// each other. Otherwise a mesh of 40,000 of them took minutes.
TEST(EmptyBalls, AreNotLookedForAmongVeryManyNeedles) {
  constexpr std::uint32_t kCount = 3000;
  std::vector<Vector> points;
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t i = 0; i <= kCount; ++i) {
    const double a = 2 * std::numbers::pi * i / kCount;
    for (const double z : {0.0, 0.02}) points.push_back({0.01 * std::cos(a), 0.01 * std::sin(a), z});
    if (i > 0) corners.insert(corners.end(), {{2 * i - 2, 2 * i, 2 * i + 1}, {2 * i - 2, 2 * i + 1, 2 * i - 1}});
  }
  const Part part = samples::joined(samples::meshOf(points, corners));
  const Model model{Part(part)};
  for (const EmptyBalls& balls : model.emptyBalls()) ASSERT_EQ(wholeRadius(balls, false), 0);
  EXPECT_GE(walk(part, 0.0005, 1e-4, 11), 0);
}

}  // namespace
}  // namespace hapticd::brep
