// SPDX-License-Identifier: MIT
#include "kernels/brep/search/search.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include "kernels/part/check.hpp"
#include "sample_meshes.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

Vector3d randomIn(std::mt19937& random, const Vector3d& lo, const Vector3d& hi) {
  std::uniform_real_distribution<double> share(0, 1);
  return lo + Vector3d(share(random), share(random), share(random)).cwiseProduct(hi - lo);
}

/// Returns the distance to the surface of a solid cylinder of radius r about z, from z = 0 to h.
double cylinderDistance(const Vector3d& p, double r, double h) {
  const double out = std::hypot(p.x(), p.y()) - r, below = -p.z(), above = p.z() - h;
  const double up = std::max(below, above);
  if (out <= 0 && up <= 0) return std::min(-out, -up);
  return std::hypot(std::max(out, 0.0), std::max(up, 0.0));
}

TEST(Search, FindsTheNearestPointOfACappedCylinder) {
  const Model model(samples::cappedCylinder(10, 20));
  Search search(model);
  std::mt19937 random(1);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vector3d p = randomIn(random, {-0.02, -0.02, -0.01}, {0.02, 0.02, 0.03});
    const Nearest& found = search.nearest(p);
    ASSERT_TRUE(found.found() && found.proved);
    const double truth = cylinderDistance(p, 0.010, 0.020);
    worst = std::max(worst, std::abs(found.distance() - truth));
    ASSERT_NEAR(found.distance(), truth, 1e-15) << p.transpose();
    EXPECT_NEAR((found.hit.point - p).norm(), found.distance(), 1e-15);
  }
  std::printf("worst error %.2g m\n", worst);
}

/// In a slow walk, many ticks need no search because the last one still proves the foot. This must not change any
/// answer.
TEST(Search, SkipsChangeNoAnswer) {
  const Model model(samples::cappedCylinder(10, 20));
  Search walking(model), cold(model);
  std::mt19937 random(2);
  std::normal_distribution<double> step(0, 1e-4);
  Vector3d p(0.011, 0, 0.005);
  int skipped = 0;
  for (int i = 0; i < 200000; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    if (p.norm() > 0.04) p *= 0.5;
    cold.reset();
    const Nearest& found = walking.nearest(p);
    skipped += found.nodes == 0;
    ASSERT_NEAR(found.distance(), cold.nearest(p).distance(), 1e-15);
  }
  EXPECT_GT(skipped, 50000);
}

/// So do ticks beside an edge, until the foot may enter one of its two faces.
TEST(Search, SkipsBesideAnEdgeChangeNoAnswer) {
  const Model model(samples::cappedCylinder(10, 20));
  Search walking(model), cold(model);
  std::mt19937 random(3);
  std::normal_distribution<double> step(0, 1e-4);
  const Vector3d outside(0, 0.013, 0.023);  // of the upper rim, far from the seam
  Vector3d p = outside;
  int skipped = 0, entered = 0;
  for (int i = 0; i < 200000; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    if ((p - outside).norm() > 0.005) p = outside;
    cold.reset();
    const Nearest& found = walking.nearest(p);
    const bool on_rim = model.edgeOf(found.hit.element) != kNone;
    skipped += on_rim && found.nodes == 0;
    entered += !on_rim;
    ASSERT_NEAR(found.distance(), cold.nearest(p).distance(), 1e-15);
    ASSERT_EQ(found.hit.element, cold.last().hit.element) << p.transpose();
  }
  EXPECT_GT(skipped, 100000);
  EXPECT_GT(entered, 1000);
}

/// A probe that rests far away gathers rows around it. An unused place among them must not look as near as they do.
TEST(Search, FindsThePartFromAnyDistance) {
  const Model model(samples::cappedCylinder(10, 20));
  Search search(model);
  for (const double far : {1.0, 1e6, 1e15, 1e17, 1e18, 3e18, 1e19, 1e30, 1e100, 1.0})
    for (int tick = 0; tick < 10; ++tick) {
      const Nearest& found = search.nearest({far, 0, 0.01});
      ASSERT_TRUE(found.found() || far > 1e18) << far;
      ASSERT_TRUE(!found.found() || std::abs(found.distance() - (far - 0.01)) <= 1e-9 * far) << far;
    }
  ASSERT_TRUE(search.nearest({0.02, 0, 0.01}).proved);
}

/// At the tip of a cone, all of its triangles are equally near, or almost.
TEST(Search, IsCertainWhereHundredsOfTrianglesMeet) {
  constexpr std::uint32_t kSides = 720;
  constexpr double kRim = 0.03, kTip = 0.02;
  std::vector<Vector> points{{0, 0, kTip}};
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double turn = 2 * std::numbers::pi * i / kSides;
    points.push_back({kRim * std::cos(turn), kRim * std::sin(turn), 0});
    corners.push_back({0, 1 + i, 1 + (i + 1) % kSides});
  }
  const Model model(samples::meshOf(std::move(points), corners));
  Search search(model);
  std::mt19937 random(6);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = randomIn(random, {-1e-4, -1e-4, kTip + 1e-4}, {1e-4, 1e-4, kTip + 2e-3});
    const Nearest& found = search.nearest(p);
    ASSERT_TRUE(found.found() && found.proved) << p.transpose();
  }
}

/// The bounds of a face without loops may be anything finite.
TEST(Model, RefusesAFaceThatReachesTooFar) {
  Part part;
  Surface plane;
  plane.kind = SurfaceKind::kPlane;
  plane.x = {1, 0, 0};
  plane.y = {0, 1, 0};
  plane.z = {0, 0, 1};
  samples::addFace(part, plane, 0, {-1e20, 0}, {1, 1});
  samples::endBody(part, BodyKind::kSheet, 0);
  ASSERT_NO_THROW(checkPart(part));
  try {
    const Model model(part);
    FAIL() << "was made";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("face 0 reaches beyond 1e15 m"), std::string::npos) << error.what();
  }
}

/// A pcurve that is shifted by 0.5 mm leaves a gap at each of its ends.
TEST(Model, NamesTheFacesWhoseLoopsHaveGaps) {
  Part part = samples::cappedCylinder(10, 20);
  EXPECT_TRUE(Model(part).warnings().empty());
  std::uint32_t line = 0;
  while (part.curves2[part.coedges[line].pcurve].kind != CurveKind::kLine) ++line;
  Curve2& moved = part.curves2[part.coedges[line].pcurve];
  const std::uint32_t face = part.coedges[line].face;
  moved.o = {moved.o[0], moved.o[1] + 0.5};
  const Model model(std::move(part));
  ASSERT_EQ(model.warnings().size(), 1u);
  const std::string& warning = model.warnings()[0];
  EXPECT_NE(warning.find("2 gaps in the loops of faces were closed by straight lines: "), warning.npos) << warning;
  EXPECT_NE(warning.find("face " + std::to_string(face) + ", 0.5 mm"), warning.npos) << warning;
}

}  // namespace
}  // namespace hapticd::brep
