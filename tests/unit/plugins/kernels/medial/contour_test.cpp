// SPDX-License-Identifier: MIT
#include "kernels/medial/contour.hpp"

#include <gtest/gtest.h>

#include <map>

#include "bodies.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

Vector3d at(const std::vector<float>& xyz, uint32_t i) {
  return Eigen::Map<const Eigen::Vector3f>(xyz.data() + 3 * std::size_t{i}).cast<double>();
}

TEST(Contour, VerticesLieOnTheEnvelope) {
  for (const bool varying : {false, true}) {
    for (const test::Sheet& sheet : test::sheets()) {
      const Skeleton skeleton = test::build(sheet, varying);
      const Contour contour(skeleton, 2e-4);
      const std::vector<float> xyz = contour.atRest();
      double outside = 0;
      for (uint32_t i = 0; i < contour.vertexCount(); ++i)
        outside = std::max(outside, -skeleton.search(at(xyz, i), {}).depth);
      EXPECT_LT(outside, 1e-6) << sheet.name;  // folds may lie inside, nothing may stand out
    }
  }
}

TEST(Contour, IsClosedAndFacesOutward) {
  for (const test::Sheet& sheet : test::sheets()) {
    const Skeleton skeleton = test::build(sheet, true);
    const Contour contour(skeleton, 2e-4);
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    const auto& index = contour.indices();
    const std::vector<float> xyz = contour.atRest();
    double volume = 0;
    for (std::size_t t = 0; t < index.size(); t += 3) {
      for (std::size_t k = 0; k < 3; ++k) ++edges[{index[t + k], index[t + (k + 1) % 3]}];
      volume += at(xyz, index[t]).dot(at(xyz, index[t + 1]).cross(at(xyz, index[t + 2]))) / 6;
    }
    int open = 0;
    for (const auto& [edge, count] : edges) {
      const auto back = edges.find({edge.second, edge.first});
      open += back == edges.end() || back->second != count ? 1 : 0;
    }
    EXPECT_EQ(open, 0) << sheet.name;
    EXPECT_GT(volume, 0) << sheet.name;
  }
}

TEST(Contour, HasTheVolumeOfAStadium) {
  SkeletonGrid grid;  // a plate 80 x 60 mm, radius 10 mm: plate, half tubes and a sphere
  grid.count = {3, 3};
  for (int i = 0; i < 9; ++i) grid.points.emplace_back(.04 * (i / 3), .03 * (i % 3), 0);
  grid.radius.assign(9, .01);
  const Contour contour(Skeleton(grid), 1e-5);
  const std::vector<float> xyz = contour.atRest();
  const auto& index = contour.indices();
  double volume = 0;
  for (std::size_t t = 0; t < index.size(); t += 3)
    volume += at(xyz, index[t]).dot(at(xyz, index[t + 1]).cross(at(xyz, index[t + 2]))) / 6;
  const double truth = .08 * .06 * .02 + M_PI * 1e-4 * (.08 + .06) + 4 * M_PI / 3 * 1e-6;
  EXPECT_NEAR(volume, truth, 2e-3 * truth);
}

TEST(Contour, AFinerChordErrorMakesMoreTriangles) {
  const Skeleton skeleton = test::build(test::sheets()[4], true);
  EXPECT_GT(Contour(skeleton, 1e-5).vertexCount(), 2 * Contour(skeleton, 1e-3).vertexCount());
}

TEST(Contour, MovesWithItsControlPoints) {
  const Skeleton skeleton = test::build(test::sheets()[0], false);
  const Contour contour(skeleton, 1e-3);
  const std::vector<float> rest = contour.atRest();
  std::vector<float> moved(rest.size());
  contour.write([](std::size_t) { return Eigen::Vector4f(0, 0, .003F, -.003F); }, moved.data(), contour.vertexCount());
  double top = -1, bottom = 1;
  for (uint32_t i = 0; i < contour.vertexCount(); ++i) {
    top = std::max(top, at(moved, i).z());
    bottom = std::min(bottom, at(moved, i).z());
  }
  EXPECT_NEAR(top, .01, 1e-7);       // skeleton up, radius less: this side stays
  EXPECT_NEAR(bottom, -.004, 1e-7);  // and the other comes by both
}

}  // namespace
}  // namespace hapticd::medial
