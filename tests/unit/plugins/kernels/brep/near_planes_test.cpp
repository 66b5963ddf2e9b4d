// SPDX-License-Identifier: MIT
/// Tests the planes between a slow probe and the triangles of a mesh.
#include "kernels/brep/search/near_planes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/brep/geometry/geometry.hpp"
#include "kernels/brep/geometry/triangle_foot.hpp"
#include "kernels/brep/search/search.hpp"
#include "sample_meshes.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

std::array<Vector3d, 3> cornersOf(const Part& part, Element triangle) {
  const auto& c = part.triangles[triangle.index()].corner;
  return {vec(part.points[c[0]]), vec(part.points[c[1]]), vec(part.points[c[2]])};
}

Vector3d footOn(const Part& part, Element triangle, const Vector3d& p) {
  const auto c = cornersOf(part, triangle);
  return triangleFoot(p, c[0], c[1], c[2]).point;
}

double distanceTo(const Part& part, Element triangle, const Vector3d& p) {
  return (footOn(part, triangle, p) - p).norm();
}

Vector3d inBall(std::mt19937& random, double radius) {
  std::uniform_real_distribution<double> share(-1, 1);
  return radius * Vector3d(share(random), share(random), share(random));
}

/// What the planes say about a probe, compared with the truth.
struct Compared {
  int bounds = 0, close = 0;

  void add(double bound, double rounding, double truth) {
    ASSERT_LE(bound, truth + rounding);
    ++bounds;
    close += bound > 0.9 * truth;
  }
};

/// Planes of rows and of triangles of many shapes and sizes, for probes from 10 nm to 10 cm about the place where the
/// planes were made.
TEST(NearPlanes, AreNeverFartherThanTheTriangles) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> exponent(-8, -1);
  const Part part = samples::scatteredTriangles(random);
  const Model model(part);
  const BodyTree& body = model.body(0);
  Compared rows, triangles;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d center = inBall(random, 0.06);
    NearTriangles near;
    if (!near.gather(body, center, std::array{0.001, 0.004, 0.01}[static_cast<std::size_t>(i % 3)])) continue;
    NearPlanes planes;
    planes.make(near, BoxProbe(body.tree, center), center, 1);
    for (int r = 0; r < near.rows() && planes.hasRoom(); ++r) {
      const Element triangle = body.elements[near.row(r / 4, r % 4).first];
      const Vector3d at = center + inBall(random, std::pow(10, exponent(random)));
      planes.learn(planes.add(triangle), at, footOn(part, triangle, at), cornersOf(part, triangle));
    }
    for (int k = 0; k < 8; ++k) {
      const double far = std::pow(10, exponent(random));
      const Vector3d p = center + inBall(random, far);
      const PlaneProbe probe = planes.probe(p);
      for (int plane = 0; plane < 4 * planes.fours(); ++plane) {
        const auto bound = static_cast<double>(planes.distances(plane / 4, probe)[plane % 4]);
        if (!(bound < 1e6)) continue;  // an unused place
        double truth = std::numeric_limits<double>::infinity();
        if (planes.isRow(plane) && plane < near.rows()) {
          const ElementRow row = near.row(plane / 4, plane % 4);
          for (std::uint32_t e = row.first; e < row.first + row.count; ++e)
            truth = std::min(truth, distanceTo(part, body.elements[e], p));
        } else if (!planes.isRow(plane)) {
          truth = distanceTo(part, planes.triangle(plane), p);
        }
        if (truth < 1e6) (planes.isRow(plane) ? rows : triangles).add(bound, NearPlanes::rounding(truth, probe), truth);
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(rows.close, rows.bounds / 20);
  EXPECT_GT(triangles.close, triangles.bounds / 4);
  EXPECT_GT(std::min(rows.bounds, triangles.bounds), 10000);
}

/// A probe inside a triangle, or inside the disc of its row, knows no plane: the bound is not above zero.
TEST(NearPlanes, BoundNothingWhereTheProbeTouches) {
  std::mt19937 random(22);
  const Part part = samples::scatteredTriangles(random);
  const Model model(part);
  const BodyTree& body = model.body(0);
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Element triangle = body.elements[i];
    const auto corners = cornersOf(part, triangle);
    const Vector3d touch = (corners[0] + corners[1] + corners[2]) / 3;
    NearTriangles near;
    if (!near.gather(body, touch, 1e-5)) continue;
    NearPlanes planes;
    planes.make(near, BoxProbe(body.tree, touch), touch, 1);
    const int own = planes.add(triangle);
    planes.learn(own, touch, touch, corners);
    const PlaneProbe probe = planes.probe(touch);
    double least = 1;
    for (int plane = 0; plane < 4 * planes.fours(); ++plane) {
      const auto bound = static_cast<double>(planes.distances(plane / 4, probe)[plane % 4]);
      ASSERT_FALSE(std::isnan(bound)) << i;
      if (plane == own) {
        ASSERT_LE(bound, 1e-15) << i;
      }
      least = std::min(least, bound);
    }
    ASSERT_LE(least, 1e-15) << i;
  }
}

/// A slow probe examines little more than the triangle of its last foot. Without planes, it examines four to five.
TEST(NearPlanes, LeaveFewTrianglesToASlowProbe) {
  const Model model(samples::sheet(300, 0.004));
  Search search(model);
  std::int64_t examined = 0;
  constexpr int kTicks = 4000;
  for (int i = 0; i < kTicks; ++i) {
    const double x = 0.01 + 1e-5 * i, y = 0.03 + 3e-6 * i;
    search.nearest({x, y, 0.004 * std::sin(200 * x) * std::cos(170 * y) + 0.0005});
    ASSERT_TRUE(search.last().proved) << i;
    examined += search.last().elements;
  }
  EXPECT_LT(examined, 3 * kTicks);
}

}  // namespace
}  // namespace hapticd::brep
