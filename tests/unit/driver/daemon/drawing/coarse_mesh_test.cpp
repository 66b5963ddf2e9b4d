// SPDX-License-Identifier: MIT
// Drawings that are coarser than the model: how many triangles they have, how far they are off, and what they keep.
#include "drawing/coarse_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "drawing/triangle_distance.hpp"

namespace hapticd::drawing {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A mesh as a plugin gives it: each triangle has corners and flat normals of its own.
struct Mesh {
  std::vector<float> xyz, normals;
  std::vector<uint32_t> indices;
  std::vector<uint32_t> colours;  ///< empty, or one per vertex

  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const Vector3f n = (b - a).cross(c - a).normalized().cast<float>();
    for (const Vector3d& p : {a, b, c}) {
      for (int axis = 0; axis < 3; ++axis) {
        xyz.push_back(static_cast<float>(p[axis]));
        normals.push_back(n[axis]);
      }
      indices.push_back(static_cast<uint32_t>(indices.size()));
    }
  }
  hsp_mesh view() const {
    return {sizeof(hsp_mesh),
            static_cast<uint32_t>(xyz.size() / 3),
            static_cast<uint32_t>(indices.size() / 3),
            0,
            xyz.data(),
            normals.data(),
            indices.data(),
            colours.empty() ? nullptr : colours.data()};
  }
};

/// Adds a surface over (0..1)^2 as a grid of n x n squares.
template <class At>
void addGrid(Mesh& mesh, int n, At&& at) {
  const auto p = [&](int i, int k) { return at(static_cast<double>(i) / n, static_cast<double>(k) / n); };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      mesh.add(p(i, k), p(i + 1, k), p(i + 1, k + 1));
      mesh.add(p(i, k), p(i + 1, k + 1), p(i, k + 1));
    }
}

/// A ball of 40 mm with bumps, about its origin.
Mesh bumpyBall(int n) {
  Mesh mesh;
  addGrid(mesh, n, [](double u, double v) {
    const double turn = 2 * std::numbers::pi * (u == 1 ? 0 : u), polar = std::numbers::pi * (1 - v);
    const double across = v == 0 || v == 1 ? 0 : std::sin(polar);
    const double radius = 0.04 + 0.001 * across * across * std::sin(5 * turn);
    return Vector3d(radius * across * std::cos(turn), radius * across * std::sin(turn), radius * std::cos(polar));
  });
  return mesh;
}

/// A box from 0 to `size`, each side a grid of n x n squares.
Mesh box(const Vector3d& size, int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double end : {0.0, 1.0})
      addGrid(mesh, n, [&](double u, double v) {
        Vector3d p;
        p[axis] = end;
        p[(axis + 1) % 3] = end == 1 ? u : v;
        p[(axis + 2) % 3] = end == 1 ? v : u;
        return Vector3d(p.cwiseProduct(size));
      });
  return mesh;
}

Vector3d placeOf(const hsp_mesh& mesh, uint32_t vertex) {
  return Eigen::Map<const Vector3f>(mesh.xyz + 3 * vertex).cast<double>();
}

/// The largest distance of a vertex of `from` from the triangles of `to`, by brute force.
double farthest(const hsp_mesh& from, const hsp_mesh& to) {
  double largest = 0;
  std::set<std::vector<float>> seen;
  for (uint32_t i = 0; i < from.vertex_count; ++i) {
    if (!seen.insert({from.xyz[3 * i], from.xyz[3 * i + 1], from.xyz[3 * i + 2]}).second) continue;
    double nearest = INFINITY;
    for (uint32_t t = 0; t < to.triangle_count && nearest > largest; ++t)
      nearest = std::min(nearest, distance(placeOf(from, i), placeOf(to, to.indices[3 * t]),
                                           placeOf(to, to.indices[3 * t + 1]), placeOf(to, to.indices[3 * t + 2])));
    largest = std::max(largest, nearest);
  }
  return largest;
}

/// Six times the volume that the triangles enclose, divided by 6.
double volume(const hsp_mesh& mesh) {
  double sum = 0;
  for (uint32_t t = 0; t < mesh.triangle_count; ++t)
    sum += placeOf(mesh, mesh.indices[3 * t])
               .dot(placeOf(mesh, mesh.indices[3 * t + 1]).cross(placeOf(mesh, mesh.indices[3 * t + 2]))) /
           6;
  return sum;
}

/// What holds for every reduced mesh. Returns it.
CoarseMesh reduced(const Mesh& mesh, size_t most) {
  const hsp_mesh full = mesh.view();
  const CoarseMesh coarse = MeshReducer(full).reduce(most);
  const hsp_mesh drawn = coarse.view();
  EXPECT_LE(drawn.triangle_count, most);
  EXPECT_GT(drawn.triangle_count, 0u);
  for (const uint32_t i : coarse.indices) EXPECT_LT(i, drawn.vertex_count);
  std::set<std::vector<float>> places;
  for (size_t i = 0; i < mesh.xyz.size(); i += 3) places.insert({mesh.xyz.begin() + i, mesh.xyz.begin() + i + 3});
  for (size_t i = 0; i < coarse.xyz.size(); i += 3)
    EXPECT_TRUE(places.contains({coarse.xyz.begin() + i, coarse.xyz.begin() + i + 3})) << "not a corner of the plugin";
  const double off = farthest(full, drawn);
  EXPECT_GE(coarse.off, off - 1e-9) << "a corner is farther away than the drawing says";
  EXPECT_LE(coarse.off, 3 * off + 1e-9) << "the drawing is much nearer than it says";
  return coarse;
}

TEST(CoarseMesh, ABallKeepsItsShapeAndItsNormals) {
  const Mesh ball = bumpyBall(120);
  const CoarseMesh coarse = reduced(ball, 3000);
  const hsp_mesh drawn = coarse.view();
  EXPECT_GE(drawn.triangle_count, 1500u) << "most of what is allowed is used";
  EXPECT_LT(coarse.off, 5e-4);
  EXPECT_NEAR(volume(drawn) / volume(ball.view()), 1, 0.03);
  for (uint32_t t = 0; t < drawn.triangle_count; ++t) {
    const uint32_t* at = drawn.indices + 3 * t;
    const Vector3d a = placeOf(drawn, at[0]), up = (placeOf(drawn, at[1]) - a).cross(placeOf(drawn, at[2]) - a);
    Vector3d sum = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      const Vector3d n = Eigen::Map<const Vector3f>(drawn.normals + 3 * at[k]).cast<double>();
      EXPECT_NEAR(n.norm(), 1, 1e-5);
      EXPECT_GT(n.dot(placeOf(drawn, at[k])) / placeOf(drawn, at[k]).norm(), 0.8) << "a normal points inward";
      sum += n;
    }
    EXPECT_GE(up.dot(sum), 0) << "a triangle is turned over";
  }
}

TEST(CoarseMesh, MoreTrianglesAreNearer) {
  const Mesh ball = bumpyBall(70);
  double before = INFINITY;
  for (const size_t most : {300, 1500, 7000}) {
    const CoarseMesh coarse = reduced(ball, most);
    EXPECT_LT(coarse.off, 0.6 * before);
    before = coarse.off;
  }
}

TEST(CoarseMesh, ABoxKeepsItsCornersAndSharpEdges) {
  const CoarseMesh coarse = reduced(box({0.1, 0.06, 0.03}, 40), 800);
  EXPECT_LT(coarse.off, 1e-7);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d wanted((corner & 1) * 0.1, (corner & 2) / 2 * 0.06, (corner & 4) / 4 * 0.03);
    double nearest = INFINITY;
    for (uint32_t i = 0; i < coarse.view().vertex_count; ++i)
      nearest = std::min(nearest, (placeOf(coarse.view(), i) - wanted).norm());
    EXPECT_LT(nearest, 1e-7) << "corner " << corner;
  }
  for (size_t i = 0; i < coarse.normals.size(); i += 3)
    EXPECT_GT(Eigen::Map<const Vector3f>(&coarse.normals[i]).cwiseAbs().maxCoeff(), 0.999f) << "an edge is rounded";
}

TEST(CoarseMesh, BothSidesOfAThinPlateAreDrawn) {
  const Mesh plate = box({0.1, 0.1, 1e-4}, 40);
  const CoarseMesh coarse = reduced(plate, 600);
  double area[2] = {};
  const hsp_mesh drawn = coarse.view();
  for (uint32_t t = 0; t < drawn.triangle_count; ++t) {
    const uint32_t* at = drawn.indices + 3 * t;
    const Vector3d a = placeOf(drawn, at[0]), up = (placeOf(drawn, at[1]) - a).cross(placeOf(drawn, at[2]) - a);
    area[up.z() > 0] += std::abs(up.z()) / 2;
  }
  EXPECT_NEAR(area[0], 0.01, 1e-4);
  EXPECT_NEAR(area[1], 0.01, 1e-4);
}

TEST(CoarseMesh, WhatIsSmallerThanTheGridDoesNotVanish) {
  Mesh mesh = bumpyBall(60);
  // a needle of 100 mm and 1 um beside the ball, and a grain far away
  mesh.add({0.05, 0, 0}, {0.15, 0, 0}, {0.15, 1e-6, 0});
  mesh.add({0, 0, 0.3}, {1e-6, 0, 0.3}, {0, 1e-6, 0.3});
  const CoarseMesh coarse = reduced(mesh, 300);
  EXPECT_LT(coarse.off, 0.05);
  double top = 0;
  for (size_t i = 2; i < coarse.xyz.size(); i += 3) top = std::max(top, static_cast<double>(coarse.xyz[i]));
  EXPECT_NEAR(top, 0.3, 1e-6);
}

TEST(CoarseMesh, AThousandGrainsBecomeFewTriangles) {
  Mesh mesh;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, 0.1), small(-1e-4, 1e-4);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p(place(random), place(random), place(random));
    const auto near = [&] { return Vector3d(p + Vector3d(small(random), small(random), small(random))); };
    mesh.add(near(), near(), near());
  }
  reduced(mesh, 100);
}

TEST(CoarseMesh, MoreTrianglesOfDustAreNotFewer) {
  Mesh mesh;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> place(0, 0.1), small(-1e-4, 1e-4);
  for (int i = 0; i < 1000; ++i) {
    std::array<Vector3d, 4> p;
    const Vector3d middle(place(random), place(random), place(random));
    for (Vector3d& corner : p) corner = middle + Vector3d(small(random), small(random), small(random));
    for (size_t k = 0; k < 4; ++k) mesh.add(p[k], p[(k + 1) % 4], p[(k + 2) % 4]);
  }
  for (const size_t most : {500, 1000, 2000, 3000}) EXPECT_GT(reduced(mesh, most).indices.size() / 3, most / 2);
}

TEST(CoarseMesh, CornersThatShareAVertexMakeNoDifference) {
  const Mesh ball = bumpyBall(40);
  const CoarseMesh one = MeshReducer(ball.view()).reduce(500), again = MeshReducer(ball.view()).reduce(500);
  EXPECT_EQ(one.xyz, again.xyz);
  EXPECT_EQ(one.normals, again.normals);
  EXPECT_EQ(one.indices, again.indices);
  Mesh shared = ball;
  std::map<std::vector<float>, uint32_t> first;
  for (uint32_t& i : shared.indices) i = first.insert({{&ball.xyz[3 * i], &ball.xyz[3 * i] + 3}, i}).first->second;
  hsp_mesh bare = ball.view(), joined = shared.view();
  bare.normals = joined.normals = nullptr;
  const CoarseMesh apart = MeshReducer(bare).reduce(500), together = MeshReducer(joined).reduce(500);
  EXPECT_TRUE(apart.normals.empty());
  EXPECT_EQ(apart.xyz, together.xyz);
  EXPECT_EQ(apart.indices, together.indices);
}

TEST(CoarseMesh, ColoursDoNotMix) {
  Mesh plate;
  addGrid(plate, 100, [](double u, double v) { return Vector3d(0.1 * u, 0.1 * v, 0); });
  for (size_t i = 0; i < plate.indices.size(); i += 3) {
    double x = 0;  // of the triangle's middle
    for (size_t k = 0; k < 3; ++k) x += plate.xyz[3 * (i + k)] / 3;
    plate.colours.insert(plate.colours.end(), 3, x < 0.05 ? 0xff0000ffu : 0xff00ff00u);
  }
  const CoarseMesh coarse = reduced(plate, 500);
  const hsp_mesh drawn = coarse.view();
  ASSERT_EQ(coarse.colours.size(), drawn.vertex_count);
  double red = 0, green = 0;
  for (uint32_t t = 0; t < drawn.triangle_count; ++t) {
    const uint32_t* at = drawn.indices + 3 * t;
    ASSERT_EQ(drawn.colours[at[0]], drawn.colours[at[1]]);
    ASSERT_EQ(drawn.colours[at[0]], drawn.colours[at[2]]);
    const Vector3d a = placeOf(drawn, at[0]);
    const double area = 0.5 * (placeOf(drawn, at[1]) - a).cross(placeOf(drawn, at[2]) - a).norm();
    (drawn.colours[at[0]] == 0xff0000ffu ? red : green) += area;
  }
  EXPECT_NEAR(red, 0.005, 5e-4);
  EXPECT_NEAR(green, 0.005, 5e-4);
}

TEST(CoarseMesh, AScanWithAColourAtEachPointStaysSmooth) {
  Mesh plate;
  addGrid(plate, 100, [](double u, double v) { return Vector3d(0.1 * u, 0.1 * v, 0); });
  const auto redAt = [](double x) { return static_cast<uint32_t>(std::lround(2550 * x)); };
  for (size_t i = 0; i < plate.indices.size(); ++i) plate.colours.push_back(0xff000000u | redAt(plate.xyz[3 * i]));
  const CoarseMesh coarse = reduced(plate, 500);
  const hsp_mesh drawn = coarse.view();
  ASSERT_EQ(coarse.colours.size(), drawn.vertex_count);
  EXPECT_LT(drawn.vertex_count, 2 * drawn.triangle_count) << "corners share vertices";
  for (uint32_t i = 0; i < drawn.vertex_count; ++i)
    EXPECT_NEAR(drawn.colours[i] & 0xffu, redAt(placeOf(drawn, i).x()), 40) << i;
}

TEST(CoarseMesh, EnoughRoomChangesNothing) {
  const Mesh ball = bumpyBall(30);
  const CoarseMesh coarse = reduced(ball, ball.indices.size() / 3);
  EXPECT_LT(coarse.off, 1e-12);
}

TEST(CoarseMesh, TrianglesWithoutAreaAreNoHarm) {
  Mesh point, line;
  for (int i = 0; i < 300; ++i) {
    point.add({0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}, {0.1, 0.2, 0.3});
    line.add({i * 1e-3, 0, 0}, {(i + 1) * 1e-3, 0, 0}, {(i + 0.5) * 1e-3, 0, 0});
  }
  for (float& n : point.normals) n = 0;
  for (float& n : line.normals) n = 0;
  EXPECT_EQ(reduced(point, 100).off, 0);
  reduced(line, 100);
}

TEST(TriangleDistance, IsThatToTheNearestPlace) {
  const Vector3d a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);
  EXPECT_DOUBLE_EQ(distance({0.5, 0.5, 3}, a, b, c), 3);
  EXPECT_DOUBLE_EQ(distance({0.5, 0.5, -3}, a, b, c), 3);
  EXPECT_DOUBLE_EQ(distance({1, -2, 0}, a, b, c), 2);
  EXPECT_DOUBLE_EQ(distance({2, 2, 0}, a, b, c), std::numbers::sqrt2);
  EXPECT_DOUBLE_EQ(distance({-3, -4, 0}, a, b, c), 5);
  EXPECT_DOUBLE_EQ(distance({5, 0, 4}, a, b, c), 5);
  EXPECT_DOUBLE_EQ(distance({5, 0, 4}, a, a, b), 5);
}

}  // namespace
}  // namespace hapticd::drawing
