// SPDX-License-Identifier: MIT
/// Tests the discs around rows of triangles, and ticks that examine only the gathered rows around the probe.
#include "kernels/brep/search/near_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "kernels/brep/geometry/geometry.hpp"
#include "kernels/brep/geometry/triangle_foot.hpp"
#include "kernels/brep/search/descent.hpp"
#include "kernels/brep/search/search.hpp"
#include "sample_meshes.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

double distanceTo(const Part& part, std::uint32_t triangle, const Vector3d& p) {
  const auto& c = part.triangles[triangle].corner;
  return (triangleFoot(p, vec(part.points[c[0]]), vec(part.points[c[1]]), vec(part.points[c[2]])).point - p).norm();
}

/// The probes are at distances from a nanometre to a metre.
TEST(RowDisc, BoundsNoTriangleFromAbove) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(-1, 1), exponent(-9, 0);
  const Model model(samples::scatteredTriangles(random));
  const BodyTree& body = model.body(0);
  int close = 0;
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(body.tree.nodeCount()); ++n)
    for (std::size_t i = 0; i < 4; ++i) {
      if (body.tree.node(n).child[i] >= 0) continue;
      const RowDisc& disc = body.discs[static_cast<std::size_t>(body.tree.node(n).row[i])];
      const FourDiscs four = fourOf(disc, disc, disc, disc);
      const ElementRow row = BoxTree::rowOf(body.tree.node(n).child[i]);
      for (int k = 0; k < 40; ++k) {
        const std::uint32_t corner = model.part().triangles[body.elements[row.first].index()].corner[k % 3u];
        const Vector3d away(share(random), share(random), share(random));
        const Vector3d p = vec(model.part().points[corner]) + std::pow(10, exponent(random)) * away;
        double truth = 1e300;
        for (std::uint32_t e = row.first; e < row.first + row.count; ++e)
          truth = std::min(truth, distanceTo(model.part(), body.elements[e].index(), p));
        const BoxProbe probe(body.tree, p);
        const auto bound = static_cast<double>(rowDistance(disc, probe));
        ASSERT_LE(bound, truth * truth) << p.transpose();
        ASSERT_LE(static_cast<double>(rowDistances(four, probe)[k % 4]), truth * truth) << p.transpose();
        close += bound > 0.25 * truth * truth;
      }
    }
  EXPECT_GT(close, 20000);
}

/// Returns the least distance from p to a triangle that is in none of the gathered rows.
double leastOfOthers(const Model& model, const NearTriangles& rows, const Vector3d& p) {
  std::vector<char> gathered(model.part().triangles.size(), 0);
  for (int r = 0; r < rows.rows(); ++r) {
    const ElementRow row = rows.row(r / 4, r % 4);
    for (std::uint32_t i = row.first; i < row.first + row.count; ++i) gathered[model.body(0).elements[i].index()] = 1;
  }
  double least = 1e300;
  for (std::uint32_t t = 0; t < gathered.size(); ++t)
    if (gathered[t] == 0) least = std::min(least, distanceTo(model.part(), t, p));
  return least;
}

/// Walks at several speeds, with rests and jumps, and compares with a search whose budget is too small for gathered
/// rows or a walk. @param spares true to check that gathering saves nodes
void walkBeside(const Model& model, unsigned seed, bool spares) {
  const SearchBudget whole{2048, NearTriangles::kMostRows * BodyTree::kMeshRow};
  Search near(model), all(model);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(-0.1, 1.1);
  const Eigen::AlignedBox3d box = model.bounds();
  Vector3d p = box.center(), way(0, 0, 0);
  std::int64_t near_nodes = 0, all_nodes = 0;
  const bool knows_neighbours = std::any_of(model.emptyBalls().begin(), model.emptyBalls().end(),
                                            [](const EmptyBalls& balls) { return balls.around != 0; });
  for (int i = 0; i < 60000; ++i) {
    const double step = std::array{1e-6, 1.25e-5, 5e-5, 3e-4, 2e-3}[static_cast<std::size_t>(i / 3000 % 5)];
    if (i % 3000 == 0) p = box.min() + Vector3d(share(random), share(random), 0.5).cwiseProduct(box.sizes());
    way = 0.95 * way + 0.3 * Vector3d(normal(random), normal(random), normal(random));
    const Nearest before = near.last();
    if (i % 1000 > 50 && before.found()) p += step * way.normalized() + 0.05 * (before.hit.point - p);
    const Nearest& found = near.nearest(p);
    const Nearest& truth = all.nearest(p, whole);
    ASSERT_EQ(found.proved, truth.proved) << i;
    if (found.hit.element == truth.hit.element) {
      ASSERT_EQ(found.hit.d2, truth.hit.d2) << i;
      ASSERT_TRUE(found.hit.point == truth.hit.point && found.hit.u == truth.hit.u && found.hit.v == truth.hit.v);
      ASSERT_EQ(found.hit.region, truth.hit.region) << i;
    } else {  // both triangles have the nearest point on their common edge
      ASSERT_TRUE(knows_neighbours && found.hit.region != 0 && truth.hit.region != 0) << i;
      ASSERT_LE((found.hit.point - truth.hit.point).norm(), 1e-15) << i;
    }
    near_nodes += found.nodes;
    all_nodes += truth.nodes;
  }
  if (spares) {
    EXPECT_LT(near_nodes, all_nodes);
  }
}

TEST(NearRows, ChangeNoBitOfAnyAnswer) {
  walkBeside(Model(samples::sheet(150, 0.004)), 1, true);
  walkBeside(Model(samples::joined(samples::sheet(150, 0.004))), 3, true);
  walkBeside(Model(samples::sheet(60, 0)), 2, false);  // flat, so that many triangles are equally near
}

/// No triangle outside the gathered rows is nearer than beyond() says, also after the probe has moved.
TEST(NearRows, BoundWhatTheyLeaveOut) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> share(-0.06, 0.06);
  const Model model(samples::scatteredTriangles(random));
  int gathered = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d center(share(random), share(random), share(random));
    NearTriangles rows;
    if (!rows.gather(model.body(0), center, std::array{0.001, 0.004, 0.01}[static_cast<std::size_t>(i % 3)])) continue;
    ++gathered;
    const Vector3d p = center + 0.01 * Vector3d(share(random), share(random), share(random));
    ASSERT_GE(leastOfOthers(model, rows, p), rows.beyond(p)) << i;
    ASSERT_GE(leastOfOthers(model, rows, center), rows.beyond(center)) << i;
  }
  EXPECT_GT(gathered, 200);
}

/// A probe that goes half of a triangle a tick finds its foot in gathered rows, and so examines fewer groups of four
/// boxes than a search from the root.
TEST(NearRows, ServeAProbeThatGoesHalfATriangleATick) {
  const SearchBudget whole{2048, NearTriangles::kMostRows * BodyTree::kMeshRow};
  const Model model(samples::sheet(300, 0.004));
  Search near(model), all(model);
  std::int64_t near_nodes = 0, all_nodes = 0;
  for (int i = 0; i < 500; ++i) {
    const double x = 0.01 + 0.00015 * i, y = 0.03 + 0.00004 * i;
    const Vector3d p(x, y, 0.004 * std::sin(200 * x) * std::cos(170 * y) + 0.0005);
    near_nodes += near.nearest(p).nodes;
    all_nodes += all.nearest(p, whole).nodes;
    ASSERT_EQ(near.last().hit.element.code, all.last().hit.element.code) << i;
  }
  EXPECT_LT(2 * near_nodes, all_nodes) << near_nodes << " " << all_nodes;
}

/// A probe that goes more than a triangle a tick gathers in each tick. After a jump into the air, where many triangles
/// are within reach, and back, it soon does so again.
TEST(NearRows, ServeAgainSoonAfterAJump) {
  const SearchBudget whole{2048, NearTriangles::kMostRows * BodyTree::kMeshRow};
  const Model model(samples::sheet(300, 0.004));
  Search near(model), all(model);
  std::int64_t near_nodes = 0, all_nodes = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = 0.01 + 0.0004 * (i % 200), y = 0.03 + 0.0001 * (i % 200);
    const double height = i % 100 == 0 ? 0.02 : 0.0005;
    const Vector3d p(x, y, 0.004 * std::sin(200 * x) * std::cos(170 * y) + height);
    near.nearest(p);
    all.nearest(p, whole);
    ASSERT_EQ(near.last().hit.element.code, all.last().hit.element.code) << i;
    if (i % 100 < 10) continue;
    near_nodes += near.last().nodes;
    all_nodes += all.last().nodes;
  }
  EXPECT_LT(2 * near_nodes, all_nodes) << near_nodes << " " << all_nodes;
}

TEST(RowDisc, FourSideBySideKeepTheirNumbers) {
  std::mt19937 random(9);
  const Model model(samples::scatteredTriangles(random));
  const std::vector<RowDisc>& discs = model.body(0).discs;
  for (std::size_t i = 0; i + 4 <= discs.size(); i += 4) {
    const FourDiscs four = fourOf(discs[i], discs[i + 1], discs[i + 2], discs[i + 3]);
    for (int lane = 0; lane < 4; ++lane) {
      const RowDisc& disc = discs[i + static_cast<std::size_t>(lane)];
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(four.center[axis][lane], disc.center[axis]) << i;
        ASSERT_EQ(four.normal[axis][lane], disc.normal[axis]) << i;
      }
      ASSERT_EQ(four.half[lane], disc.half) << i;
      ASSERT_EQ(four.radius[lane], disc.radius) << i;
    }
  }
}

/// sortChildrenAtOnce() against a stable sort, with equal bounds, bounds at the limit and unused places.
TEST(Descent, ChildrenComeFarthestFirst) {
  std::mt19937 random(10);
  std::uniform_int_distribution<int> digit(0, 5);
  constexpr float kEndless = std::numeric_limits<float>::infinity();
  int within = 0;
  for (int i = 0; i < 20000; ++i) {
    Float4 bounds;
    BoxNode node;
    for (int lane = 0; lane < 4; ++lane) {
      const int number = digit(random);
      bounds[lane] = number == 5 ? kEndless : 0.1F * static_cast<float>(number);
      node.child[static_cast<std::size_t>(lane)] = node.row[static_cast<std::size_t>(lane)] = lane;
    }
    const double limit = std::array<double, 4>{0.2, static_cast<double>(0.2F), 0, kEndless}[i % 4u];
    std::vector<DescentEntry> expected;
    double beyond = 1, expected_beyond = 1;
    for (int lane = 0; lane < 4; ++lane) {
      const auto bound = static_cast<double>(bounds[lane]);
      if (bound <= limit && bounds[lane] < kEndless) expected.push_back({bounds[lane], lane, lane});
      if (!(bound <= limit)) expected_beyond = std::min(expected_beyond, bound);
    }
    std::stable_sort(expected.begin(), expected.end(), [](auto& a, auto& b) { return a.bound > b.bound; });
    std::array<DescentEntry, 4> children;
    ASSERT_EQ(sortChildrenAtOnce(node, bounds, limit, children, beyond), static_cast<int>(expected.size())) << i;
    ASSERT_EQ(beyond, expected_beyond) << i;
    for (std::size_t k = 0; k < expected.size(); ++k) ASSERT_EQ(children[k].child, expected[k].child) << i;
    within += static_cast<int>(expected.size());
  }
  EXPECT_GT(within, 20000);
}

/// Near a corner of a cube, six triangles on three faces are equally near.
TEST(NearRows, KeepTheOrderOfPreferenceAtACube) {
  std::vector<Vector> points;
  for (int i = 0; i < 8; ++i) points.push_back({0.05 * (i & 1), 0.05 * (i >> 1 & 1), 0.05 * (i >> 2 & 1)});
  walkBeside(Model(samples::meshOf(points, {{0, 2, 3},
                                            {0, 3, 1},
                                            {4, 5, 7},
                                            {4, 7, 6},
                                            {0, 1, 5},
                                            {0, 5, 4},
                                            {2, 6, 7},
                                            {2, 7, 3},
                                            {0, 4, 6},
                                            {0, 6, 2},
                                            {1, 3, 7},
                                            {1, 7, 5}})),
             3, false);
}

}  // namespace
}  // namespace hapticd::brep
