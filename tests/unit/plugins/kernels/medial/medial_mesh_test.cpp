// SPDX-License-Identifier: MIT
#include "kernels/medial/medial_mesh.hpp"

#include <gtest/gtest.h>

#include <map>

#include "kernels/medial/mesh_contour.hpp"
#include "meshes.hpp"
#include "support/sweep.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// The least |p - c| - r over spheres sampled on every cone and slab.
double sampled(const MeshData& mesh, const Vector3d& p, int n) {
  double best = 1e300;
  const auto look = [&](const Vector3d& c, double r) { best = std::min(best, (p - c).norm() - r); };
  const auto at = [&](int v) -> const Sphere& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const Sphere& s : mesh.vertices) look(s.center, s.radius);
  for (const auto& e : mesh.edges)
    for (int i = 0; i <= n * n; ++i) {
      const double t = i / double(n * n);
      look((1 - t) * at(e[0]).center + t * at(e[1]).center, (1 - t) * at(e[0]).radius + t * at(e[1]).radius);
    }
  for (const auto& f : mesh.triangles)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const double a = i / double(n), b = j / double(n), c = 1 - a - b;
        look(c * at(f[0]).center + a * at(f[1]).center + b * at(f[2]).center,
             c * at(f[0]).radius + a * at(f[1]).radius + b * at(f[2]).radius);
      }
  return best;
}

TEST(MedialMesh, DistanceIsThatOfTheNearestSphereWhateverTheMesh) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> place(-.05, .15);
  std::vector<MeshData> meshes{test::branches(), test::sheet(6)};
  for (unsigned seed = 1; seed <= 10; ++seed) meshes.push_back(test::tangle(seed, 12, 6, 10));
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const MedialMesh mesh(meshes[m]);
    for (int k = 0; k < 100; ++k) {
      const double x = place(engine), y = place(engine), z = place(engine);
      const double exact = mesh.distance({x, y, z}), rough = sampled(meshes[m], {x, y, z}, 24);
      ASSERT_LE(exact, rough + 1e-14) << m;   // no sphere is nearer,
      ASSERT_GE(exact, rough - 2.5e-3) << m;  // and the samples are not far from the nearest
    }
  }
}

TEST(MedialMesh, StartsChangeNothingButTheEvaluations) {
  const MedialMesh mesh(test::sheet(40));
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> unit(-.02, .12);
  int warm = 0, cold = 0;
  MeshFeet feet, again;
  uint32_t start = MedialMesh::kNoStart;
  for (int k = 0; k < 2000; ++k) {
    const double x = .05 + .04 * std::sin(1e-3 * k), y = .05 + .04 * std::cos(1.3e-3 * k);
    const Vector3d p = k % 10 == 0 ? Vector3d(unit(engine), unit(engine), unit(engine)) : Vector3d(x, y, .02);
    mesh.nearest(p, MedialMesh::kNoStart, 0, feet);
    mesh.nearest(p, start, 0, again);
    ASSERT_EQ(feet.feet[0].distance, again.feet[0].distance);
    cold += feet.evaluations;
    warm += again.evaluations;
    start = again.feet[0].element;
  }
  EXPECT_LT(warm, cold);
  EXPECT_LT(warm / 2000, 30);  // of 3042 slabs
}

/// Work is counted, not timed: what a tick may take at most holds on a busy machine as well.
TEST(MedialMesh, ATickOnTenThousandSlabsLooksAtABoundedPart) {
  const MedialMesh mesh(test::ball(71));
  ASSERT_GT(mesh.elements().size(), 9'900u);
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> place(-.12, .12);
  MeshFeet feet, all;
  uint32_t start = MedialMesh::kNoStart;
  const int ticks = support::kLong ? 2000 : 500;
  for (int k = 0; k < ticks; ++k) {
    Vector3d p(place(engine), place(engine), place(engine));     // thrown about,
    if (k % 4 == 1) p *= 1e-4;                                   // in the middle, where all slabs are as near,
    if (k % 4 == 2) p = Vector3d(4. * k / ticks - 2, .01, .02);  // 2 m/s straight through,
    if (k % 4 == 3) p = .054 * Vector3d(std::sin(k), std::cos(k), .3).normalized();  // and on its skin
    mesh.nearest(p, start, 0, feet, MedialMesh::kMostVisits);
    start = feet.feet[0].element;
    ASSERT_LE(feet.visits, MedialMesh::kMostVisits);
    ASSERT_LE(feet.evaluations, MedialMesh::kMostVisits / 2 + 2);
    mesh.nearest(p, start, 0, all);
    ASSERT_LE(feet.feet[0].distance - all.feet[0].distance, feet.doubt) << k;  // what it doubts is true
    ASSERT_TRUE(k % 4 != 3 || feet.visits < 1000) << k << ": " << feet.visits;
  }
}

TEST(MedialMesh, OnTheSkinTheSearchIsNeverCutShort) {
  const MedialMesh mesh(test::ball(71));
  MeshFeet feet;
  uint32_t start = MedialMesh::kNoStart;
  for (int k = 0; k < 2000; ++k) {
    const double a = .01 * k, b = .0037 * k, r = .05 + .008 * std::sin(.1 * k);  // 8 mm in and out of a skin of 4 mm
    mesh.nearest(r * Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)), start, 0, feet,
                 MedialMesh::kMostVisits);
    start = feet.feet[0].element;
    ASSERT_EQ(feet.doubt, 0) << k;
    ASSERT_LT(feet.evaluations, 200) << k;
  }
}

TEST(MedialMesh, ABandHoldsEveryFootWithinIt) {
  const MedialMesh mesh(test::branches());
  const Vector3d crotch(.0, .009, .001);
  MeshFeet feet;
  mesh.nearest(crotch, MedialMesh::kNoStart, .002, feet);
  ASSERT_GE(feet.count, 2u);
  for (std::size_t i = 1; i < feet.count; ++i) {
    EXPECT_GE(feet.feet[i].distance, feet.feet[i - 1].distance);
    EXPECT_LT(feet.feet[i].distance, feet.feet[0].distance + .002);
  }
}

TEST(MedialMesh, WeightsGiveTheCentreOfTheFoot) {
  const MeshData data = test::tangle(4, 12, 6, 10);
  const MedialMesh mesh(data);
  std::mt19937 engine(9);
  std::uniform_real_distribution<double> unit(-.05, .15);
  MeshFeet feet;
  for (int k = 0; k < 500; ++k) {
    const double x = unit(engine), y = unit(engine), z = unit(engine);
    mesh.nearest({x, y, z}, MedialMesh::kNoStart, 0, feet);
    const MeshFoot& foot = feet.feet[0];
    const auto weights = mesh.weights(foot.element, foot.parameter);
    Vector3d center = Vector3d::Zero();
    double radius = 0;
    for (std::size_t i = 0; i < mesh.elements()[foot.element].count; ++i) {
      center += weights[i] * mesh.vertices()[mesh.elements()[foot.element].vertex[i]].center;
      radius += weights[i] * mesh.vertices()[mesh.elements()[foot.element].vertex[i]].radius;
    }
    ASSERT_LT((center - foot.center).norm(), 1e-12);
    ASSERT_NEAR(radius, foot.radius, 1e-12);
    ASSERT_NEAR(foot.normal.norm(), 1, 1e-12);
    ASSERT_LT((foot.point() - (Vector3d(x, y, z) - foot.distance * foot.normal)).norm(), 1e-9);
  }
}

TEST(MedialMesh, EdgesOfTrianglesAndVerticesOfEdgesAreNotCountedTwice) {
  MeshData data;
  for (int i = 0; i < 5; ++i) data.vertices.push_back({{.01 * i, .01 * (i % 2), 0}, .005});
  data.edges = {{0, 1}, {1, 0}, {2, 3}};
  data.triangles = {{0, 1, 2}, {2, 1, 0}};
  const MedialMesh mesh(data);  // vertex 4 alone, edge 2-3, one slab
  EXPECT_EQ(mesh.elements().size(), 3u);
}

TEST(MedialMesh, RefusesWhatIsNoMesh) {
  const auto refuses = [](const MeshData& data) { EXPECT_THROW(MedialMesh mesh(data), std::invalid_argument); };
  MeshData data;
  refuses(data);
  data.vertices = {{{0, 0, 0}, .1}, {{1, 0, 0}, .1}};
  data.edges = {{0, 2}};
  refuses(data);
  data.edges = {{0, 0}};
  refuses(data);
  data.edges = {{-1, 0}};
  refuses(data);
  data.edges = {};
  data.vertices[1].radius = -1;
  refuses(data);
  data.vertices[1].radius = NAN;
  refuses(data);
}

TEST(MedialMesh, AnswersNotANumberWithoutHarm) {
  const MedialMesh mesh(test::sheet(10));
  MeshFeet feet;
  mesh.nearest({NAN, 0, 0}, MedialMesh::kNoStart, 0, feet);
  mesh.nearest({INFINITY, 0, 0}, 3, .1, feet);
  EXPECT_GE(feet.count, 1u);
}

TEST(MeshContour, IsClosedFacesOutwardAndLiesOnTheBody) {
  for (const MeshData& data : {test::branches(), test::sheet(7)}) {
    const MedialMesh mesh(data);
    const MeshContour contour(mesh, 3e-4);
    const std::vector<float> xyz = contour.atRest();
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    const auto& index = contour.indices();
    ASSERT_GT(index.size(), 1000u);
    for (std::size_t t = 0; t < index.size(); t += 3)
      for (std::size_t k = 0; k < 3; ++k) ++edges[{index[t + k], index[t + (k + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(edges.contains({edge.second, edge.first}));
    }
    EXPECT_GT(contour.volume(xyz), 0);
    for (std::size_t i = 0; i < contour.vertexCount(); ++i) {
      const Eigen::Vector3f p = Eigen::Map<const Eigen::Vector3f>(xyz.data() + 3 * i);
      ASSERT_LT(std::fabs(mesh.distance(p.cast<double>())), 2e-4);
    }
  }
}

TEST(MeshContour, HasTheVolumeAndAreaOfACapsule) {
  MeshData data;
  data.vertices = {{{0, 0, 0}, .01}, {{.03, .01, .02}, .01}};
  data.edges = {{0, 1}};
  const double length = data.vertices[1].center.norm(), r = .01;
  const MeshContour contour(MedialMesh(data), 2e-5);
  const std::vector<float> xyz = contour.atRest();
  EXPECT_NEAR(contour.volume(xyz) / (M_PI * r * r * length + 4.0 / 3 * M_PI * r * r * r), 1, 5e-3);
  EXPECT_NEAR(contour.area(xyz) / (2 * M_PI * r * length + 4 * M_PI * r * r), 1, 1e-2);
}

}  // namespace
}  // namespace hapticd::medial
