// SPDX-License-Identifier: MIT
/// Meshes with triangles that are so narrow that the digits of the file decide where they look.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "kernels/brep/contact/tracer.hpp"
#include "sample_meshes.hpp"
#include "sample_solids.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;
using Mesh = samples::TriangleList;
using samples::partOf;

constexpr double kBallRadius = 0.03;  // [m]

/// Rounds a point to whole multiples of a digit [m].
Vector3d rounded(const Vector3d& p, double digit) {
  return Vector3d(std::round(p.x() / digit), std::round(p.y() / digit), std::round(p.z() / digit)) * digit;
}

/// A ball of 512 triangles.
Mesh ball(double digit) {
  Mesh mesh = samples::unitBall();
  for (auto& triangle : mesh)
    for (Vector3d& p : triangle) p = rounded(kBallRadius * p, digit);
  return mesh;
}

/// Puts a point on an edge of each triangle, as far as the digits allow, and a narrow triangle beside it.
Mesh withPointsOnEdges(const Mesh& mesh, double digit) {
  std::mt19937 source(5);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  Mesh cut;
  for (const auto& [a, b, c] : mesh) {
    const Vector3d q = rounded(a + share(source) * (b - a), digit);
    if ((b - a).cross(q - a).norm() > 0)
      cut.insert(cut.end(), {{a, q, c}, {q, b, c}, {a, b, q}});
    else
      cut.push_back({a, b, c});
  }
  return cut;
}

/// A sheet of 40 x 40 mm in the xz plane, whose border consists of narrow triangles.
Mesh foil(double thickness) {
  const double a = 0.02, h = 0.5 * thickness;
  const auto at = [&](int i, double y) { return Vector3d((i & 1) != 0 ? a : -a, y, (i & 2) != 0 ? a : -a); };
  Mesh mesh{{at(0, h), at(2, h), at(3, h)}, {at(0, h), at(3, h), at(1, h)}};
  mesh.insert(mesh.end(), {{at(0, -h), at(3, -h), at(2, -h)}, {at(0, -h), at(1, -h), at(3, -h)}});
  const std::array<int, 5> round{0, 1, 3, 2, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    const int from = round[i], to = round[i + 1];
    mesh.push_back({at(from, h), at(to, h), at(to, -h)});
    mesh.push_back({at(from, h), at(to, -h), at(from, -h)});
  }
  return mesh;
}

/// The deepest contact [m] of a probe that goes twice around the ball, 1 mm deep.
double deepestAround(const Model& model) {
  Tracer tracer(model);
  const Vector3d u = Vector3d(1, 0.3, 0.2).normalized(), v = u.cross(Vector3d(0.1, 0.9, 0.4)).normalized();
  double deepest = 0;
  for (int i = -20; i < 4000; ++i) {
    const double turn = 1e-3 * std::numbers::pi * std::max(i, 0), r = kBallRadius - (i < 0 ? 5e-5 * (20 + i) : 1e-3);
    deepest = std::max(deepest, tracer.step(r * (std::cos(turn) * u + std::sin(turn) * v), {}, {}).depth);
  }
  return deepest;
}

TEST(NarrowTriangles, HoldNoContact) {
  for (const double digit : {1e-7, 1e-6, 1e-5}) {
    const Mesh plain = ball(digit);
    const double expected = deepestAround(Model(partOf(plain)));
    EXPECT_GT(expected, 0.8e-3);
    EXPECT_NEAR(deepestAround(Model(partOf(withPointsOnEdges(plain, digit)))), expected, 0.2 * expected) << digit;
  }
}

TEST(NarrowTriangles, TellNoSide) {
  std::mt19937 source(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (const double digit : {1e-7, 1e-6}) {
    const Mesh plain = ball(digit);
    const Model smooth(partOf(plain)), model(partOf(withPointsOnEdges(plain, digit)));
    Tracer expected(smooth), tracer(model);
    for (int i = 0; i < 20000; ++i) {
      const auto& triangle = plain[source() % plain.size()];
      const Vector3d edge = triangle[0] + share(source) * (triangle[1] - triangle[0]);
      const Vector3d p = edge * (1 + (share(source) - 0.5) * 0.2);
      const contact::Foot foot = expected.nearest(p);
      if (foot.distance < 20 * digit) continue;
      EXPECT_EQ(tracer.nearest(p).depth > 0, foot.depth > 0) << p.transpose();
    }
  }
}

TEST(NarrowTriangles, AreRealOnTheBorderOfAFoil) {
  const double h = 2e-5;
  const Model model(partOf(foil(2 * h)));
  Tracer tracer(model);
  std::mt19937 source(9);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const Vector3d p(0.02 + 0.003 * share(source), 0.003 * share(source), 0.021 * share(source));
    const bool in = p.x() < 0.02 && std::abs(p.z()) < 0.02 && std::abs(p.y()) < h;
    EXPECT_EQ(tracer.nearest(p).depth > 0, in) << p.transpose();
  }
}

TEST(NarrowTriangles, ReleaseAContactAtTheBorderOfAFoil) {
  const Model model(partOf(foil(4e-5)));
  Tracer tracer(model);
  for (int i = 0; i <= 20; ++i) tracer.step(Vector3d(0.015, 0.001 - 1e-4 * i, 0.003), {}, {});  // 1 mm through it
  for (int i = 0; i <= 100; ++i) {
    const double x = 0.015 + 1e-4 * i;
    EXPECT_EQ(tracer.step(Vector3d(x, -0.001, 0.003), {}, {}).depth > 0, x < 0.02) << x;
  }
}

}  // namespace
}  // namespace hapticd::brep
