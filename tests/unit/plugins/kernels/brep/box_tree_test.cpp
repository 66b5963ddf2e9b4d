// SPDX-License-Identifier: MIT
#include "kernels/brep/tree/box_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hapticd::brep {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// Returns boxes that are points, `step` [m] apart along x.
std::vector<AlignedBox3d> pointsAlongX(int count, double step) {
  std::vector<AlignedBox3d> boxes;
  boxes.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) boxes.emplace_back(Vector3d(i * step, 0, 0));
  return boxes;
}

/// The inverse of the least steps overflows.
TEST(BoxTree, HoldsEachBoxOnceHoweverNearTheCentersAre) {
  for (const double step : {1.0, 1e-12, 1e-17, 1e-300, 1e-308, 1e-310, 5e-324, 0.0}) {
    BoxTree tree;
    tree.build(pointsAlongX(100, step), 2);
    std::vector<std::uint32_t> order = tree.order();
    std::sort(order.begin(), order.end());
    ASSERT_EQ(order.size(), 100u);
    for (std::uint32_t i = 0; i < 100; ++i) ASSERT_EQ(order[i], i) << step;
    EXPECT_GE(tree.rowCount(), 50) << step;
  }
}

}  // namespace
}  // namespace hapticd::brep
