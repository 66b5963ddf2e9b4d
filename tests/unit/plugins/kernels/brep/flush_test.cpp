// SPDX-License-Identifier: MIT
/// Slides a pressed probe from one body of a part onto another that stands beside it.
#include <gtest/gtest.h>

#include <array>
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
