// SPDX-License-Identifier: MIT
/// Paths that graze curved faces: a contact begins exactly if the path leads through the face.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "kernels/brep/contact/tracer.hpp"
#include "sample_solids.hpp"
#include "sample_splines.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

/// A value [m] that is above 0 on one side of a face, and about the distance near it.
using Height = std::function<double(const Vector3d&)>;

/// Makes paths of 1 um to 1 mm from points near a face, most of them nearly along it. Each is a contact of its own with
/// a shell that is felt from both sides: its end must be felt as inside exactly if it is on the other side.
void expectEntriesAsBy(const Height& height, Part part, const Vector3d& lo, const Vector3d& hi) {
  constexpr int kPaths = 20000;
  const Model model(std::move(part));
  Tracer tracer(model);
  const contact::ContactRule both{contact::Sides::kBoth};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  int entered = 0, paths = 0;
  while (paths < kPaths) {
    const Vector3d at = lo + Vector3d(share(random), share(random), share(random)).cwiseProduct(hi - lo);
    const contact::Foot near = tracer.nearest(at);
    const double length = std::pow(10, -6 + 3 * share(random));
    const Vector3d from = near.point + 0.3 * length * normal(random) * near.normal;
    const Vector3d way = Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Vector3d along = (way - 0.9 * way.dot(near.normal) * near.normal).normalized();
    const Vector3d p = from + length * along;
    if (std::abs(height(from)) < 1e-7 || std::abs(height(p)) < 1e-7) continue;
    if (((from - lo).array() < 0).any() || ((hi - from).array() < 0).any()) continue;
    ++paths;
    tracer.reset();
    tracer.step(from, both);
    const bool is_inside = tracer.step(p, both).depth > 0;
    ASSERT_EQ(is_inside, (height(from) > 0) != (height(p) > 0)) << from.transpose() << " to " << p.transpose();
    entered += is_inside;
  }
  EXPECT_GT(entered, kPaths / 20);
}

TEST(Entering, ASphere) {
  expectEntriesAsBy([](const Vector3d& p) { return p.norm() - 0.010; }, samples::sphere(10), {-0.01, -0.01, -0.008},
                    {0.01, 0.01, 0.008});
}

TEST(Entering, ACylinder) {
  expectEntriesAsBy([](const Vector3d& p) { return p.head<2>().norm() - 0.010; }, samples::cappedCylinder(10, 40),
                    {-0.012, -0.012, 0.015}, {0.012, 0.012, 0.025});
}

TEST(Entering, ACone) {
  expectEntriesAsBy([](const Vector3d& p) { return (p.head<2>().norm() + 0.5 * p.z()) / std::hypot(1, 0.5); },
                    samples::cone(10, 20), {-0.006, -0.006, -0.012}, {0.006, 0.006, -0.003});
}

TEST(Entering, ATorus) {
  expectEntriesAsBy([](const Vector3d& p) { return std::hypot(p.head<2>().norm() - 0.010, p.z()) - 0.006; },
                    samples::torus(10, 6), {-0.017, -0.017, -0.007}, {0.017, 0.017, 0.007});
}

TEST(Entering, ASplineSheet) {
  constexpr double kHeights[4][4] = {{0, 4, -3, 1}, {2, -5, 6, 0}, {-1, 5, -6, 3}, {0, 2, 4, -4}};  // [mm]
  spline::SurfaceData data;
  data.degree[0] = data.degree[1] = 3;
  data.knots[0] = data.knots[1] = {0, 0, 0, 0, 1, 1, 1, 1};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) data.points.emplace_back(0.01 * i, 0.01 * j, 0.001 * kHeights[i][j]);
  const auto height = [&](const Vector3d& p) {
    const auto bernstein = [](double t) {
      const double s = 1 - t;
      return std::array{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    };
    const auto b = bernstein(p.x() / 0.03), c = bernstein(p.y() / 0.03);  // x and y are linear in u and v
    double z = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) z += b[i] * c[j] * 0.001 * kHeights[i][j];
    return p.z() - z;
  };
  expectEntriesAsBy(height, samples::sheetOf({data}), {0.003, 0.003, -0.004}, {0.027, 0.027, 0.004});
}

/// Returns a strip of triangles, two for each pair of neighbouring points of a line that runs in the plane y = 0, and
/// 0.1 m wide along y. @param smooth_angle [rad] of the mesh
Part strip(const std::vector<Vector3d>& line, double smooth_angle) {
  Part part;
  for (const Vector3d& p : line)
    for (const double y : {-0.05, 0.05}) part.points.push_back({p.x(), y, p.z()});
  const auto count = static_cast<std::uint32_t>(line.size() - 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    Triangle lower, upper;
    lower.corner = {2 * i, 2 * i + 2, 2 * i + 1};  // edges: along y = -0.05, across the quad, at its start
    upper.corner = {2 * i + 1, 2 * i + 2, 2 * i + 3};
    lower.across = {kNone, 4 * (2 * i + 1) + 0, i == 0 ? kNone : 4 * (2 * i - 1) + 1};
    upper.across = {4 * (2 * i) + 1, i + 1 == count ? kNone : 4 * (2 * i + 2) + 2, kNone};
    part.triangles.insert(part.triangles.end(), {lower, upper});
  }
  samples::endBody(part, BodyKind::kMesh, 0);
  part.bodies.back().smooth_angle = smooth_angle;
  return part;
}

/// True if a tick from `from` to p is felt as a press, on a shell that is felt from both sides.
bool isFelt(const Model& model, const Vector3d& from, const Vector3d& p) {
  const contact::ContactRule both{contact::Sides::kBoth};
  Tracer tracer(model);
  tracer.step(from, both);
  return tracer.step(p, both).depth > 0;
}

/// The interpolated normals of a facet are not those along which the probe comes.
TEST(Entering, ASmoothedArc) {
  std::vector<Vector3d> line;
  for (int i = 0; i <= 8; ++i) line.emplace_back(0.05 * std::sin(0.1 * (i - 4)), 0, 0.05 * std::cos(0.1 * (i - 4)));
  const Model model(strip(line, 0.5));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const std::size_t k = static_cast<std::size_t>(8 * share(random));
    const double t = 0.01 + 0.98 * share(random), slope = std::pow(10, -2 * share(random));
    const Vector3d chord = line[k + 1] - line[k], along = chord.normalized();
    const Vector3d met = line[k] + t * chord + Vector3d(0, 0.09 * (share(random) - 0.5), 0);
    const Vector3d out = Vector3d(-along.z(), 0, along.x()) * (along.x() > 0 ? 1 : -1);
    const double reach = 0.5 * std::min(t, 1 - t) * chord.norm();  // the path stays over its facet
    const Vector3d way = reach * (along + slope * out) / std::hypot(1, slope);
    for (const double from : {1.0, -1.0}) {
      ASSERT_TRUE(isFelt(model, met + from * way, met - 0.5 * from * way)) << k << ' ' << t << ' ' << slope;
      ASSERT_TRUE(isFelt(model, met + from * reach * out, met - 0.5 * from * reach * out)) << k << ' ' << t;
    }
  }
}

/// The distance to a free edge is not the height over its triangle.
TEST(Entering, ASheetOverItsFreeEdge) {
  const Model model(strip({{0, 0, 0}, {0.1, 0, 0}}, 0));
  EXPECT_TRUE(isFelt(model, {-1e-4, 0, 1e-5}, {2e-4, 0, -1e-5}));
  EXPECT_FALSE(isFelt(model, {-1e-4, 0, 1e-6}, {2e-5, 0, -1e-5}));  // passes in front of the edge
}

/// Rounding must not decide on which side of a face a step of the way ends.
TEST(Entering, APlaneFarFromTheOriginByShallowPaths) {
  const Model model(samples::prism({{0, 0}, {100, 0}, {100, 150}, {0, 150}}, 100));  // the plane y = 0.15
  for (const double slope : {1e-1, 1e-2, 3e-3, 1e-3})
    for (const double height : {1e-6, 3e-7, 1e-7, 3e-8, 1.5e-8})
      for (int i = 0; i < 300; ++i)
        for (const double side : {1.0, -1.0}) {
          const double way = height / slope;
          const Vector3d from(0.03 + 1e-4 * i, 0.15 + side * height, 0.04 + 1e-5 * i);
          const Vector3d p = from + Vector3d(1.2 * way, -1.8 * side * height, 0.9 * way);
          ASSERT_TRUE(isFelt(model, from, p)) << slope << ' ' << height << ' ' << side;
        }
}

/// Near the axis of a tube, all triangles look equally near: a search of little work runs out, and the foot that it has
/// is farther than the nearest one. The path must not step over the wall there.
TEST(Entering, AWallThatIsNearerThanTheSearchKnows) {
  constexpr int kPoints = 20000;
  constexpr SearchBudget kLittle{2048, 1};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> wobble(0.0098, 0.0102), angle(0, 2 * M_PI);
  std::vector<Vector3d> line;
  for (int i = 0; i <= kPoints; ++i) {
    const double a = 2 * M_PI * i / kPoints;
    line.push_back(wobble(random) * Vector3d(std::cos(a), 0, std::sin(a)));
  }
  const Model model(strip(line, 0));
  Tracer tracer(model);
  int degraded = 0;
  for (int i = 0; i < 200; ++i) {
    const double a = angle(random);
    tracer.reset();
    degraded +=
        tracer.step(Vector3d::Zero(), {contact::Sides::kBoth}, kLittle).status == contact::FootStatus::kDegraded;
    const Vector3d p(0.015 * std::cos(a), 0, 0.015 * std::sin(a));
    EXPECT_GT(tracer.step(p, {contact::Sides::kBoth}, kLittle).depth, 0) << "path " << i;
  }
  EXPECT_GT(degraded, 150);
}

}  // namespace
}  // namespace hapticd::brep
