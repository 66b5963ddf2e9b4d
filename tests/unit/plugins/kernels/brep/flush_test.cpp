// SPDX-License-Identifier: MIT
/// Slides a pressed probe from one body of a part onto another that stands beside it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kernels/brep/contact/tracer.hpp"
#include "sample_meshes.hpp"
#include "sample_solids.hpp"

namespace hapticd::brep {
namespace {

using contact::Foot;
using Eigen::Vector3d;

constexpr double kSize = 0.010;  ///< [m] of a block

Part block() {
  return samples::prism({{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 10);
}

/// The same block, of triangles.
Part blockOfTriangles() {
  constexpr std::array<std::array<int, 3>, 12> kCorners{{{0, 1, 3},
                                                         {0, 3, 2},
                                                         {4, 6, 7},
                                                         {4, 7, 5},
                                                         {0, 4, 5},
                                                         {0, 5, 1},
                                                         {2, 3, 7},
                                                         {2, 7, 6},
                                                         {0, 2, 6},
                                                         {0, 6, 4},
                                                         {1, 5, 7},
                                                         {1, 7, 3}}};
  const auto corner = [](int i) -> Vector3d { return kSize * Vector3d(i / 4, i / 2 % 2, i % 2); };
  samples::TriangleList triangles;
  for (const auto& [a, b, c] : kCorners) triangles.push_back({corner(a), corner(b), corner(c)});
  return samples::partOf(triangles);
}

/// Two blocks side by side along x. The second one stands higher by `rise` [m], with a gap of `gap` [m].
Part blocks(Part part, double rise, double gap = 0) {
  part.instances.push_back(part.instances[0]);
  part.instances.back().pose[3] = kSize + gap;
  part.instances.back().pose[11] = rise;
  return part;
}

/// Adds a body: the prism over a rectangle from x0 to x1 [mm] in x, and from z0 to z1 in z.
void addBlock(Part& part, double x0, double x1, double z0, double z1) {
  samples::Polyhedron made;
  made.part = std::move(part);
  const std::array<std::array<double, 2>, 4> corners{{{x0, 0}, {x1, 0}, {x1, 10}, {x0, 10}}};
  const auto at = [&](std::size_t i, double z) { return Vector3d(corners[i % 4][0], corners[i % 4][1], z); };
  made.addPolygon({{at(0, z1), at(1, z1), at(2, z1), at(3, z1)}});
  made.addPolygon({{at(3, z0), at(2, z0), at(1, z0), at(0, z0)}});
  for (std::size_t i = 0; i < 4; ++i) made.addPolygon({{at(i, z0), at(i + 1, z0), at(i + 1, z1), at(i, z1)}});
  samples::endBody(made.part, BodyKind::kSolid, kClosed);
  part = std::move(made.part);
}

/// Leads a probe over the joint of two blocks, on a slanted path that also presses in or lets go: it must always feel
/// the top of the block that it is in.
void expectTopsOnSlantedPaths(const Part& part, double rise) {
  const Model model{Part(part)};
  for (const double step : {1e-6, 2e-5, 1.5e-4})
    for (const double aside : {-2.0, 0.0, 1.0})
      for (const double press : {-0.3, -0.01, 0.0, 0.3}) {
        Tracer tracer(model);
        const Vector3d way = step * Vector3d(1, aside, -press).normalized();
        Vector3d p = Vector3d(kSize, 0.005, kSize - 8e-4) - 9.3 * way;
        tracer.step({p.x(), p.y(), kSize + 1e-3}, {});
        for (int i = 0; i < 20; ++i, p += way) {
          const Foot foot = tracer.step(p, {});
          const double top = kSize + (p.x() > kSize ? rise : 0);
          if (!(top - p.z() > 2e-5) || p.z() < 0.005) break;
          ASSERT_NEAR(foot.depth, top - p.z(), 1e-9) << rise << " up, step " << step << ", " << aside << ", " << press;
          ASSERT_GT(foot.normal.z(), 0.999) << rise << " up, step " << step << ", " << aside << ", " << press;
        }
      }
}

/// Presses a probe into the top of the first block and leads it along x over the second one. Returns the feet.
std::vector<Foot> slide(const Part& part, double depth, double step, double aside, bool back) {
  const Model model{Part(part)};
  Tracer tracer(model);
  const Vector3d a(back ? 0.017 : 0.003, 0.004, kSize - depth), b(back ? 0.003 : 0.017, 0.004 + aside, kSize - depth);
  tracer.step(a + Vector3d(0, 0, depth + 0.001), {});
  std::vector<Foot> feet;
  const int count = static_cast<int>((b - a).norm() / step);
  for (int i = 0; i <= count; ++i) feet.push_back(tracer.step(a + (b - a) * i / count, {}));
  return feet;
}

TEST(FlushBodies, AreFeltAsOneSurface) {
  for (const Part& part : {blocks(block(), 0), blocks(blockOfTriangles(), 0)})
    for (const double depth : {1e-4, 1e-3, 3e-3})
      for (const double step : {1.3e-5, 1e-4, 7e-4})
        for (const double aside : {0.0, 0.003})
          for (const bool back : {false, true})
            for (const Foot& foot : slide(part, depth, step, aside, back)) {
              ASSERT_NEAR(foot.depth, depth, 1e-12) << depth << " deep, steps of " << step;
              ASSERT_NEAR(foot.normal.z(), 1, 1e-12) << depth << " deep, steps of " << step;
            }
}

TEST(FlushBodies, AreFeltAsOneOnSlantedPaths) {
  for (const Part& part : {block(), blockOfTriangles()})
    for (const double rise : {0.0, 3e-7, -3e-7, 8e-6, 4e-5}) expectTopsOnSlantedPaths(blocks(part, rise), rise);
}

TEST(FlushBodies, AStepDownThatWasPressedThroughHasNoWall) {
  for (const Part& part : {block(), blockOfTriangles()})
    for (const double rise : {-2e-5, -1e-4, -4e-4}) expectTopsOnSlantedPaths(blocks(part, rise), rise);
}

TEST(FlushBodies, TheTopmostOfAStackIsFelt) {
  Part part;
  addBlock(part, 0, 10, 0, 10);
  addBlock(part, 10, 20, 0, 9.7);  // the probe is in this one
  addBlock(part, 10, 20, 9.7, 10);
  expectTopsOnSlantedPaths(part, 0);
}

TEST(FlushBodies, ANarrowStripIsFeltAsWell) {
  Part part;
  addBlock(part, 0, 10, 0, 10);
  addBlock(part, 10, 10.06, 0, 10);
  addBlock(part, 10.06, 20, 0, 10);
  expectTopsOnSlantedPaths(part, 0);
}

TEST(FlushBodies, OfOneCylinderAreFeltAsOne) {
  Part part = samples::cappedCylinder(5, 20);
  part.instances.push_back(part.instances[0]);
  part.instances.back().pose[11] += 0.020;
  const Model model(std::move(part));
  for (const double step : {1e-6, 2e-5, 1.5e-4})
    for (const double turn : {0.0, 2.0})
      for (const double press : {-0.3, 0.0, 0.3}) {
        Tracer tracer(model);
        double angle = 1, height = 0.020 - 5.4 * step, r = 0.0042;
        tracer.step({0.006 * std::cos(angle), 0.006 * std::sin(angle), height}, {});
        for (int i = 0; i < 20 && r < 0.00498; ++i) {
          const Foot foot = tracer.step({r * std::cos(angle), r * std::sin(angle), height}, {});
          ASSERT_NEAR(foot.depth, 0.005 - r, 1e-9) << "step " << step << ", turn " << turn << ", press " << press;
          angle += turn * step / r, height += step, r -= press * step;
        }
      }
}

TEST(FlushBodies, AreNotThoseOfAnotherHeight) {
  for (const Part& part : {block(), blockOfTriangles()}) {
    const std::vector<Foot> up = slide(blocks(part, 0.002), 5e-4, 1e-4, 0, false);
    EXPECT_NEAR(up.back().normal.x(), -1, 1e-12);  // a wall
    EXPECT_NEAR(up.back().depth, 0.007, 1e-12);
    const std::vector<Foot> down = slide(blocks(part, -0.002), 5e-4, 1e-4, 0, false);
    EXPECT_NEAR(down.back().depth, -0.0015, 1e-12);  // the hand has left the first block, and is above the second
    const std::vector<Foot> beyond = slide(blocks(part, 0, 0.001), 5e-4, 1e-4, 0, false);
    EXPECT_NEAR(beyond.back().normal.x(), -1, 1e-12);  // a wall beyond a gap that is wider than a step
  }
}

}  // namespace
}  // namespace hapticd::brep
