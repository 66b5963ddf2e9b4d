// SPDX-License-Identifier: MIT
#include "kernels/medial/soft_weights.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "meshes.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 3>;

constexpr double kInside = 1e-7;  ///< barycentric weight that is all but an edge's

/// Acute, right-angled, obtuse and thin ones.
std::vector<Corners> slabs() {
  std::vector<Corners> all{{Vector3d(0, 0, 0), Vector3d(.01, 0, 0), Vector3d(.004, .009, .002)},
                           {Vector3d(0, 0, 0), Vector3d(.01, 0, 0), Vector3d(0, .01, 0)},
                           {Vector3d(0, 0, 0), Vector3d(.01, 0, 0), Vector3d(-.006, .004, .001)},
                           {Vector3d(0, 0, 0), Vector3d(.02, 0, 0), Vector3d(.011, .0005, 0)}};
  return all;
}

/// The gradient [1/m] of a corner's weight in the plane of a slab.
Vector3d gradientOf(const Corners& slab, const CornerWeights& weights, std::size_t i) {
  Eigen::Matrix<double, 3, 2> edges;
  edges << slab[1] - slab[0], slab[2] - slab[0];
  return edges * (edges.transpose() * edges).inverse() * Eigen::Vector2d(weights.along_u[i], weights.along_v[i]);
}

TEST(SoftWeights, AreASharingWithTheDerivativesThatTheySay) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform;
  for (const Corners& slab : slabs()) {
    for (int k = 0; k < 2000; ++k) {
      double u = uniform(engine), v = uniform(engine);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const CornerWeights w = softOnSlab(slab, u, v);
      EXPECT_NEAR(w.value[0] + w.value[1] + w.value[2], 1, 1e-12);
      if (std::min({u, v, 1 - u - v}) < 1e-3) continue;
      const double h = 1e-7;
      const CornerWeights a = softOnSlab(slab, u + h, v), b = softOnSlab(slab, u - h, v);
      const CornerWeights c = softOnSlab(slab, u, v + h), d = softOnSlab(slab, u, v - h);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GE(w.value[i], 0);
        const double size = 1 + std::fabs(w.along_u[i]) + std::fabs(w.along_v[i]);
        EXPECT_NEAR(w.along_u[i], (a.value[i] - b.value[i]) / (2 * h), 1e-4 * size) << u << " " << v;
        EXPECT_NEAR(w.along_v[i], (c.value[i] - d.value[i]) / (2 * h), 1e-4 * size) << u << " " << v;
      }
    }
  }
}

/// There a neighbour takes over, or the body ends: the weights are those of the edge's own corners, as on a cone, and
/// have no slope across it.
TEST(SoftWeights, OnAnEdgeAreItsOwnWithoutASlopeAcrossIt) {
  for (const Corners& slab : slabs()) {
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const std::size_t second = (edge + 1) % 3, opposite = (edge + 2) % 3;
      const Vector3d along = (slab[second] - slab[edge]).normalized();
      for (double t = .05; t < 1; t += .1) {
        std::array<double, 3> b{};
        b[edge] = (1 - kInside) * (1 - t), b[second] = (1 - kInside) * t, b[opposite] = kInside;
        const CornerWeights here = softOnSlab(slab, b[1], b[2]), cone = softOnCone(t);
        EXPECT_NEAR(here.value[edge], cone.value[0], 1e-5);
        EXPECT_NEAR(here.value[second], cone.value[1], 1e-5);
        for (std::size_t i = 0; i < 3; ++i) {
          const Vector3d gradient = gradientOf(slab, here, i);
          const double across = (gradient - gradient.dot(along) * along).norm();
          EXPECT_LT(across, 1e-2) << "edge " << edge << " at " << t;  // 1/m; linear weights have 100 and more
        }
        const double follows = gradientOf(slab, here, second).dot(slab[second] - slab[edge]);
        EXPECT_NEAR(follows, cone.along_u[1], 1e-4);
      }
    }
  }
}

TEST(SoftWeights, ACornerHasAllAndNoSlope) {
  for (const Corners& slab : slabs()) {
    for (const auto& [u, v] : {std::pair{0., 0.}, {1., 0.}, {0., 1.}, {1e-9, 1e-9}, {1 - 2e-9, 1e-9}}) {
      const CornerWeights w = softOnSlab(slab, u, v);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(w.value[i], i == 1 ? std::round(u) : i == 2 ? std::round(v) : std::round(1 - u - v), 1e-12);
        EXPECT_NEAR(w.along_u[i], 0, 1e-4);
        EXPECT_NEAR(w.along_v[i], 0, 1e-4);
      }
    }
  }
  const CornerWeights begin = softOnCone(0), end = softOnCone(1);
  EXPECT_EQ(begin.value[0], 1);
  EXPECT_EQ(end.value[1], 1);
  EXPECT_EQ(begin.along_u[1], 0);
  EXPECT_EQ(end.along_u[1], 0);
}

TEST(SoftWeights, OfASlabWithoutAPlaneAreFinite) {
  const Vector3d p(.01, 0, 0), q(.02, 0, 0);
  for (const Corners& slab : {Corners{p, p, p}, Corners{p, p, q}, Corners{p, q, q}}) {
    for (const double t : {0., .3, 1.}) {
      const CornerWeights w = softOnSlab(slab, t, 0);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(w.value[i] + w.along_u[i] + w.along_v[i]));
    }
  }
}

/// A flat sheet of n x n vertices 10 mm apart, with a straight rope of cones at its last corner.
MeshData sheetWithRope(int n) {
  MeshData mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) mesh.vertices.push_back({{.01 * i, .01 * j, 0}, .008});
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = i * n + j;
      mesh.triangles.push_back({a, a + n, a + n + 1});
      mesh.triangles.push_back({a, a + n + 1, a + 1});
    }
  for (int k = 1; k <= 3; ++k) {
    const int here = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back({{.01 * (n - 1) + .01 * k, .01 * (n - 1), 0}, .008});
    mesh.edges.push_back({here - 1, here});
  }
  return mesh;
}

TEST(MeshEnds, AreRimsTipsJoinsAndSharpBends) {
  const int n = 5;
  const std::vector<uint8_t> ends = endsOf(MedialMesh(sheetWithRope(n)));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const bool rim = i == 0 || j == 0 || i == n - 1 || j == n - 1;
      EXPECT_EQ(ends[static_cast<std::size_t>(i * n + j)], rim ? 1 : 0) << i << " " << j;
    }
  EXPECT_EQ((std::vector<uint8_t>(ends.end() - 3, ends.end())), (std::vector<uint8_t>{0, 0, 1}));
  for (const double rise : {.1, .5}) {  // 6 degrees and 27 degrees at vertex 1
    const MedialMesh bent({{{{0, 0, 0}, .01}, {{.01, 0, 0}, .01}, {{.02, 0, .01 * rise}, .01}}, {{0, 1}, {1, 2}}, {}});
    EXPECT_EQ(endsOf(bent)[1], rise > .3 ? 1 : 0);
  }
  const int m = 36;  // a ball has no rim, but for its poles, where this one has thin slabs
  const std::vector<uint8_t> ball = endsOf(MedialMesh(test::ball(m)));
  for (int i = 0; i < m; ++i)
    for (int j = 2; j <= m - 2; ++j) EXPECT_EQ(ball[static_cast<std::size_t>(i * (m + 1) + j)], 0) << i << " " << j;
}

/// From slab to slab neither the weights of the vertices nor, at a rim, their slopes jump.
TEST(MeshEnds, WeightsAreContinuousAndLevelAtTheRim) {
  const int n = 4;
  const MedialMesh mesh(sheetWithRope(n));
  const std::vector<uint8_t> ends = endsOf(mesh);
  std::vector<double> before(mesh.vertices().size(), 0), here(before);
  for (int k = -1000; k <= 31000; ++k) {  // 1 um a step, obliquely over the sheet and over its rim
    const Vector3d p(.0007 + .6e-6 * k, 1e-6 * k, .009);
    MeshFeet feet;
    mesh.nearest(p, MedialMesh::kNoStart, 0, feet);
    const MeshFoot& foot = feet.feet[0];
    const CornerWeights weights = weightsTowardEnds(mesh, ends, foot.element, foot.parameter);
    std::fill(here.begin(), here.end(), 0);
    for (std::size_t i = 0; i < 3; ++i) here[mesh.elements()[foot.element].vertex[i]] += weights.value[i];
    for (std::size_t i = 0; i < here.size(); ++i) ASSERT_LT(k > -1000 ? std::fabs(here[i] - before[i]) : 0, 4e-4) << k;
    if (std::fabs(foot.center.y()) < 1e-9 || std::fabs(foot.center.y() - .03) < 1e-9) {
      const MedialMesh::Element& e = mesh.elements()[foot.element];
      const auto center = [&](std::size_t i) { return mesh.vertices()[e.vertex[i]].center; };
      for (std::size_t i = 0; e.count == 3 && i < 3; ++i)
        ASSERT_NEAR(gradientOf({center(0), center(1), center(2)}, weights, i).y(), 0, 1e-6) << k;
    }
    std::swap(before, here);
  }
}

}  // namespace
}  // namespace hapticd::medial
