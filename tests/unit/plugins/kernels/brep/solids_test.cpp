// SPDX-License-Identifier: MIT
/// Nearest points and sides of solids whose distance has a closed form.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <random>

#include "kernels/brep/contact/tracer.hpp"
#include "sample_solids.hpp"

namespace hapticd::brep {
namespace {

using contact::Foot;
using Eigen::Vector3d;

/// Distance [m] from the surface of a solid, negative inside.
using Signed = std::function<double(const Vector3d&)>;

Vector3d randomBetween(std::mt19937& random, const Vector3d& lo, const Vector3d& hi) {
  std::uniform_real_distribution<double> share(0, 1);
  return lo + Vector3d(share(random), share(random), share(random)).cwiseProduct(hi - lo);
}

/// Returns the number of queries of each run below. HAPTICD_PART_TICKS changes it, such as 1e8 for a long run.
int queries() {
  const char* asked = std::getenv("HAPTICD_PART_TICKS");
  return asked != nullptr ? static_cast<int>(std::atof(asked)) : 80000;
}

/// Makes cold queries in a box that is half as large again as the part, and walks. Every foot must be proved, and its
/// distance and side must be right.
void expectTruth(Part part, const Signed& truth, double tolerance = 1e-14) {
  const Model model(std::move(part));
  const Vector3d grow = 0.25 * model.bounds().sizes() + Vector3d::Constant(1e-3);
  const Vector3d lo = model.bounds().min() - grow, hi = model.bounds().max() + grow;
  Tracer tracer(model);
  std::mt19937 random(7);
  std::normal_distribution<double> step(0, 2e-4);
  Vector3d p = model.bounds().max();
  int proved = 0;
  const int count = queries();
  for (int i = 0; i < count; ++i) {
    if (i % 2 == 0 || i < 200) {
      p = randomBetween(random, lo, hi);
    } else {
      p += Vector3d(step(random), step(random), step(random));
    }
    const Foot foot = tracer.nearest(p);
    const double expected = truth(p);
    ASSERT_NEAR(foot.distance, std::abs(expected), tolerance) << i << ": " << p.transpose();
    ASSERT_NEAR((foot.point - p).norm(), foot.distance, 1e-14);
    if (std::abs(expected) > 1e-9) {
      ASSERT_EQ(foot.depth > 0, expected < 0) << i << ": " << p.transpose();
    }
    ASSERT_NEAR(foot.normal.norm(), 1, 1e-6);
    proved += foot.status == contact::FootStatus::kNearest;
  }
  EXPECT_EQ(proved, count);
}

/// Returns the distance in the plane from the point (a, b) to the segment from (a0, b0) to (a1, b1).
double toSegment(double a, double b, double a0, double b0, double a1, double b1) {
  const double da = a1 - a0, db = b1 - b0;
  const double t = std::clamp(((a - a0) * da + (b - b0) * db) / (da * da + db * db), 0.0, 1.0);
  return std::hypot(a - a0 - t * da, b - b0 - t * db);
}

/// Returns the signed distance from a prism, computed from the distance to its polygon in the plane.
Signed prismTruth(std::vector<std::array<double, 2>> polygon, double h) {
  return [polygon, h](const Vector3d& p) {
    double side = 1e9;
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      side = std::min(side, toSegment(p.x(), p.y(), a[0] * 1e-3, a[1] * 1e-3, b[0] * 1e-3, b[1] * 1e-3));
      const double ay = a[1] * 1e-3, by = b[1] * 1e-3;
      if ((ay <= p.y()) != (by <= p.y()) && p.x() < a[0] * 1e-3 + (p.y() - ay) / (by - ay) * (b[0] - a[0]) * 1e-3)
        inside = !inside;
    }
    const double out = inside ? -side : side, up = std::max(-p.z(), p.z() - h * 1e-3);
    if (out <= 0 && up <= 0) return std::max(out, up);
    return std::hypot(std::max(out, 0.0), std::max(up, 0.0));
  };
}

TEST(Solids, Box) {
  const std::vector<std::array<double, 2>> square{{0, 0}, {30, 0}, {30, 20}, {0, 20}};
  expectTruth(samples::prism(square, 10), prismTruth(square, 10));
}

TEST(Solids, BracketWithAConcaveEdge) {
  const std::vector<std::array<double, 2>> ell{{0, 0}, {30, 0}, {30, 10}, {10, 10}, {10, 30}, {0, 30}};
  expectTruth(samples::bracket(), prismTruth(ell, 20));
}

TEST(Solids, Sphere) {
  expectTruth(samples::sphere(15), [](const Vector3d& p) { return p.norm() - 0.015; });
}

TEST(Solids, Torus) {
  expectTruth(samples::torus(20, 6),
              [](const Vector3d& p) { return std::hypot(std::hypot(p.x(), p.y()) - 0.020, p.z()) - 0.006; });
}

TEST(Solids, ConeWithItsApex) {
  expectTruth(samples::cone(10, 20), [](const Vector3d& p) {
    const double r = std::hypot(p.x(), p.y()), z = p.z();
    const double d = std::min(toSegment(r, z, 0, 0, 0.010, -0.020), toSegment(r, z, 0, -0.020, 0.010, -0.020));
    return z > -0.020 && z < 0 && r < -z / 2 ? -d : d;
  });
}

TEST(Solids, PlateWithHoles) {
  constexpr int kColumns = 12, kRows = 7;
  expectTruth(samples::plate(kColumns, kRows, 1.5, 5, 3), [](const Vector3d& p) {
    const double w = kColumns * 5e-3, d = kRows * 5e-3;
    const double outer = std::max({-p.x(), p.x() - w, -p.y(), p.y() - d});
    // Distance in the plane to the outline or to the rim of the nearest hole.
    double rim = 1e9;
    bool in_hole = false;
    for (int i = 0; i < kColumns; ++i)
      for (int j = 0; j < kRows; ++j) {
        const double r = std::hypot(p.x() - (i + 0.5) * 5e-3, p.y() - (j + 0.5) * 5e-3) - 1.5e-3;
        rim = std::min(rim, std::abs(r));
        in_hole = in_hole || r < 0;
      }
    const double beside = std::hypot(std::max({-p.x(), p.x() - w, 0.0}), std::max({-p.y(), p.y() - d, 0.0}));
    const bool inside = outer <= 0 && !in_hole;
    const double edge = std::min(rim, outer > 0 ? beside : -outer);
    const double out = inside ? -edge : edge, up = std::max(-p.z(), p.z() - 3e-3);
    if (out <= 0 && up <= 0) return std::max(out, up);
    return std::hypot(std::max(out, 0.0), std::max(up, 0.0));
  });
}

/// Probes on an axis, in a centre, and probes that are not finite.
TEST(Solids, DegenerateProbesHaveAnAnswer) {
  const Model can(samples::cappedCylinder(10, 40)), ball(samples::sphere(15)), ring(samples::torus(20, 6));
  Tracer in_can(can), in_ball(ball), in_ring(ring);
  EXPECT_NEAR(in_can.nearest({0, 0, 0.02}).depth, 0.010, 1e-15);
  EXPECT_NEAR(in_ball.nearest({0, 0, 0}).depth, 0.015, 1e-15);
  EXPECT_NEAR(in_ring.nearest({0.02, 0, 0}).depth, 0.006, 1e-15);
  EXPECT_NEAR(in_ring.nearest({0, 0, 0}).depth, -0.014, 1e-15);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(in_can.step({nan, 0, 0}, {}).status, contact::FootStatus::kInvalid);
  EXPECT_EQ(in_can.step({0, 1e300, 0}, {}).status, contact::FootStatus::kInvalid);
  EXPECT_NEAR(in_can.step({0.011, 0, 0.02}, {}).depth, -0.001, 1e-15);
}

TEST(Edges, AreClassified) {
  const auto kindsOf = [](Part part) {
    std::map<EdgeKind, int> kinds;
    const Model model(std::move(part));
    for (const Edge& edge : model.part().edges) ++kinds[edge.kind];
    return kinds;
  };
  const auto bracket = kindsOf(samples::bracket());
  EXPECT_EQ(bracket.at(EdgeKind::kConcave), 1);
  EXPECT_EQ(bracket.at(EdgeKind::kConvex), 17);
  const auto can = kindsOf(samples::cappedCylinder(10, 20));
  EXPECT_EQ(can.at(EdgeKind::kSmooth), 1);
  EXPECT_EQ(can.at(EdgeKind::kConvex), 2);
  const auto tip = kindsOf(samples::cone(10, 20));
  EXPECT_EQ(tip.at(EdgeKind::kPole), 1);
  EXPECT_EQ(tip.at(EdgeKind::kConvex), 1);
  const auto ring = kindsOf(samples::torus(20, 6));
  EXPECT_EQ(ring.at(EdgeKind::kSmooth), 2);
}

}  // namespace
}  // namespace hapticd::brep
