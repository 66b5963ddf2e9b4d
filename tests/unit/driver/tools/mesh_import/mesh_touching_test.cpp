// SPDX-License-Identifier: MIT
/// Solids that touch along an edge.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "cube.hpp"
#include "kernels/brep/contact/tracer.hpp"

namespace hapticd::importing {
namespace {

/// Two cubes with one common edge, the second turned inside out if wanted.
std::string touchingCubes(bool inside_out) {
  const std::string points = "v 2 1 0\nv 2 2 0\nv 1 2 0\nv 2 1 1\nv 2 2 1\nv 1 2 1\n";  // 9 to 14; 3 and 7 are common
  return kCube + points +
         (inside_out ? "f 3 9 10 11\nf 14 13 12 7\nf 7 12 9 3\nf 12 13 10 9\nf 13 14 11 10\nf 14 7 3 11\n"
                     : "f 11 10 9 3\nf 7 12 13 14\nf 3 9 12 7\nf 9 10 13 12\nf 10 11 14 13\nf 11 3 7 14\n");
}

TEST(MeshImport, TakesSolidsThatTouchAlongAnEdgeAsClosed) {
  for (const bool inside_out : {false, true}) {
    MeshReport report;
    const brep::Part part = partOf(touchingCubes(inside_out), report);
    EXPECT_EQ(report.touching, 1u);
    EXPECT_EQ(report.non_manifold, 0u);
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.volume, 2, 1e-14);
    EXPECT_EQ(report.flipped, inside_out ? 12u : 0u);
    EXPECT_EQ(part.bodies[0].flags, brep::kClosed);
    EXPECT_EQ(linesOf(report).back(), "1 edge has more than two triangles, those of solids that touch there");
  }
}

TEST(MeshImport, SidesAreRightBesideAnEdgeAlongWhichSolidsTouch) {
  MeshReport report;
  const brep::Model model(partOf(touchingCubes(false), report));
  brep::Tracer tracer(model);
  std::mt19937 source(5);
  std::uniform_real_distribution<double> share(-1, 1);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const double reach = std::pow(10, -5 * (i % 5) / 4.0) * 1.3;  // down to 13 um from the common edge
    const Eigen::Vector3d p(1 + reach * share(source), 1 + reach * share(source), 0.5 + 0.7 * share(source));
    const bool in =
        p.x() > 0 && p.x() < 2 && (p.x() < 1) == (p.y() < 1) && p.y() > 0 && p.y() < 2 && p.z() > 0 && p.z() < 1;
    EXPECT_EQ(tracer.nearest(p).depth > 0, in) << p.transpose();
    inside += in ? 1 : 0;
  }
  EXPECT_GT(inside, 5000);
}

}  // namespace
}  // namespace hapticd::importing
