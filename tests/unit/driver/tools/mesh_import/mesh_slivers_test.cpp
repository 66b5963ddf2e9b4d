// SPDX-License-Identifier: MIT
/// Triangles whose direction only the rounding of their corners decides.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "../../../plugins/kernels/brep/sample_meshes.hpp"
#include "cube.hpp"
#include "kernels/brep/contact/tracer.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;
using Mesh = brep::samples::TriangleList;

constexpr double kRadius = 0.03;  // [m]

/// A ball of 512 triangles.
Mesh ball() {
  Mesh mesh = brep::samples::unitBall();
  for (auto& triangle : mesh)
    for (Vector3d& p : triangle) p *= kRadius;
  return mesh;
}

/// Puts a point on an edge of each triangle, rounded to single precision, and a triangle without width beside it, as
/// programs do that cut bodies from one another.
Mesh withPointsOnEdges(const Mesh& mesh) {
  std::mt19937 source(5);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  Mesh cut;
  for (const auto& [a, b, c] : mesh) {
    const Vector3d q = (a + share(source) * (b - a)).cast<float>().cast<double>();
    cut.insert(cut.end(), {{a, q, c}, {q, b, c}, {a, b, q}});
  }
  return cut;
}

MeshFile fileOf(const Mesh& mesh) {
  MeshFile file;
  std::vector<Vector3d>& points = file.points;
  for (const auto& triangle : mesh) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = std::find(points.begin(), points.end(), triangle[k]);
      corners[k] = static_cast<std::uint32_t>(found - points.begin());
      if (found == points.end()) points.push_back(triangle[k]);
    }
    file.corners.push_back(corners);
  }
  return file;
}

/// The deepest contact [m] of a probe that goes twice around the ball, 1 mm deep.
double deepestAround(const brep::Model& model) {
  brep::Tracer tracer(model);
  const Vector3d u = Vector3d(1, 0.3, 0.2).normalized(), v = u.cross(Vector3d(0.1, 0.9, 0.4)).normalized();
  double deepest = 0;
  for (int i = -20; i < 4000; ++i) {
    const double turn = 1e-3 * std::numbers::pi * std::max(i, 0), r = kRadius - (i < 0 ? 5e-5 * (20 + i) : 1e-3);
    deepest = std::max(deepest, tracer.step(r * (std::cos(turn) * u + std::sin(turn) * v), {}, {}).depth);
  }
  return deepest;
}

TEST(MeshImport, HoldsNoContactAtATriangleThatRoundingMade) {
  MeshReport plain, cut;
  const double expected = deepestAround(brep::Model(meshPart(fileOf(ball()), {}, "ball.obj", plain)));
  const brep::Model model(meshPart(fileOf(withPointsOnEdges(ball())), {}, "ball.obj", cut));
  EXPECT_EQ(cut.slivers, 512u);
  EXPECT_TRUE(cut.closed);
  EXPECT_EQ(cut.triangles, 3u * 512u);
  EXPECT_NEAR(cut.volume, plain.volume, 1e-6 * plain.volume);
  EXPECT_GT(expected, 0.8e-3);
  EXPECT_NEAR(deepestAround(model), expected, 1e-6);
}

TEST(MeshImport, JoinsTheEndsOfAnEdgeThatRoundingMade) {
  std::string text = std::string(kCube) + "v 1.0000001 1 1\n";  // beside point 7
  text.replace(text.find("f 5 6 7 8"), 9, "f 5 6 9 8");
  text.replace(text.find("f 3 4 8 7"), 9, "f 3 4 8 9");
  text += "f 7 9 6\nf 7 3 9\n";  // needles between the faces and the one of x = 1
  MeshReport report;
  EXPECT_EQ(partOf(text, report).triangles.size(), 12u);
  EXPECT_EQ(report.joined, 1u);
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 1, 1e-6);
}

/// A ball of a script, of squares that are cut in two: sin(pi) is not quite 0, so its south pole is a ring, and so is
/// the seam at the end of each turn not quite its begin.
Mesh ballOfRings(int rings, int sides) {
  const auto at = [&](int i, int j) -> Vector3d {
    const double u = std::numbers::pi * i / rings, v = 2 * std::numbers::pi * j / sides;
    const Vector3d p(std::sin(u) * std::cos(v), std::cos(u), std::sin(u) * std::sin(v));
    return (kRadius * p).cast<float>().cast<double>();
  };
  Mesh mesh;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sides; ++j) {
      mesh.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  return mesh;
}

TEST(MeshImport, ClosesThePoleAndTheSeamOfABallOfRings) {
  for (const auto& [rings, sides] : {std::pair(10, 20), std::pair(10, 300)}) {
    MeshReport report;
    const brep::Model model(meshPart(fileOf(ballOfRings(rings, sides)), {}, "ball.stl", report));
    EXPECT_TRUE(report.closed) << report.free_edges << " free edges";
    EXPECT_EQ(report.triangles, 2u * static_cast<unsigned>(sides) * static_cast<unsigned>(rings - 1));
    EXPECT_EQ(report.slivers, 0u);
    brep::Tracer tracer(model);
    for (int i = 0; i < 50; ++i) tracer.step(Vector3d(0, -kRadius - 1e-3 + 4e-5 * i, 0), {}, {});
    EXPECT_GT(tracer.step(Vector3d(0, -kRadius + 1e-3, 0), {}, {}).depth, 0) << "the south pole pushes";
  }
}

TEST(MeshImport, KeepsNarrowTrianglesThatRoundingDidNotMake) {
  std::string text = std::string(kCube) + "v 0.5 -0.0001 0\n";  // 200 times as far from its edge as rounding is
  text.replace(text.find("f 1 2 6 5"), 9, "f 1 9 2\nf 1 2 6\nf 1 6 5");
  text.replace(text.find("f 4 3 2 1"), 9, "f 9 1 4\nf 2 9 4\nf 3 2 4");
  MeshReport report;
  partOf(text, report);
  EXPECT_EQ(report.slivers, 0u);
  EXPECT_TRUE(report.closed);
}

}  // namespace
}  // namespace hapticd::importing
