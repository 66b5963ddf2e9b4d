// SPDX-License-Identifier: MIT
#include "traced_shape/thin_walls.hpp"

#include <gtest/gtest.h>

#include "../kernels/brep/sample_meshes.hpp"
#include "../kernels/brep/sample_solids.hpp"

namespace hapticd {
namespace {

using namespace brep::samples;

brep::Part plate(double thick_mm) {
  return prism({{0, 0}, {60, 0}, {60, 40}, {0, 40}}, thick_mm);
}

TEST(ThinWalls, MeasuresThePlateThatAPressComesOutOf) {
  const brep::Model thin(plate(2));
  const auto wall = thinnestWall(thin, 0.010);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->thickness, 0.002, 1e-6);
  EXPECT_LT(wall->feature, 2u) << thin.featureName(wall->feature);  // top or bottom, no side
  EXPECT_FALSE(thinnestWall(thin, 0.0019));
  EXPECT_TRUE(thinnestWall(thin, 0.0021));
}

TEST(ThinWalls, FindsNoneWhereAllIsThicker) {
  const brep::Model two_legs(bracket());  // legs of 10 mm
  EXPECT_FALSE(thinnestWall(two_legs, 0.0099));
  const auto leg = thinnestWall(two_legs, 0.012);
  ASSERT_TRUE(leg);
  EXPECT_NEAR(leg->thickness, 0.010, 1e-6);
}

TEST(ThinWalls, TakesTheWidthOfACurvedSolid) {
  const brep::Model ball(sphere(5));
  EXPECT_FALSE(thinnestWall(ball, 0.009));
  const auto across = thinnestWall(ball, 0.011);
  ASSERT_TRUE(across);
  EXPECT_NEAR(across->thickness, 0.010, 1e-6);
}

/// A nut is thin, but its bolt fills it.
TEST(ThinWalls, GoesOnIntoTheSolidBehind) {
  brep::Part two = plate(2);
  two.instances.push_back(two.instances[0]);
  two.instances[1].pose[11] += 0.002;
  const brep::Model stacked(std::move(two));
  EXPECT_FALSE(thinnestWall(stacked, 0.003));
  const auto both = thinnestWall(stacked, 0.005);
  ASSERT_TRUE(both);
  EXPECT_NEAR(both->thickness, 0.004, 1e-6);
}

/// The bore of a nut is near its sides, but no tip comes into it.
TEST(ThinWalls, PressesNoFaceThatIsCovered) {
  brep::Part three = plate(2);
  for (const double height : {-0.002, 0.002}) {
    three.instances.push_back(three.instances[0]);
    three.instances.back().pose[11] += height;
  }
  const brep::Model stacked(std::move(three));
  EXPECT_FALSE(thinnestWall(stacked, 0.0055));
  const auto all = thinnestWall(stacked, 0.007);
  ASSERT_TRUE(all);
  EXPECT_NEAR(all->thickness, 0.006, 1e-6);
}

/// The tip of a wedge is as thin as one likes, but a press slides off its faces.
TEST(ThinWalls, LeavesCornersOut) {
  const brep::Model prism_of_three(prism({{0, 0}, {60, 0}, {30, 52}}, 60));
  EXPECT_FALSE(thinnestWall(prism_of_three, 0.010));
}

/// A pyramid of 40 mm with a point beside each edge of its base. @param beside [m] by how much they are off their edges
TriangleList pyramid(const Vector3d& beside) {
  const Vector3d top(0, 0, 0.04);
  const std::array<Vector3d, 4> base{Vector3d(-0.02, -0.02, 0), Vector3d(0.02, -0.02, 0), Vector3d(0.02, 0.02, 0),
                                     Vector3d(-0.02, 0.02, 0)};
  TriangleList mesh{{base[0], base[2], base[1]}, {base[0], base[3], base[2]}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d &a = base[i], &b = base[(i + 1) % 4], q = 0.5 * (a + b) + beside;
    mesh.insert(mesh.end(), {{a, q, top}, {q, b, top}, {a, b, q}});
  }
  return mesh;
}

TEST(ThinWalls, TellsOfNoneBehindATriangleThatRoundingMade) {
  for (int i = 0; i < 16; ++i) {
    const double turn = 2 * std::numbers::pi * i / 16;
    const brep::Model part(partOf(pyramid(1e-8 * Vector3d(std::cos(turn), std::cos(turn), std::sin(turn)))));
    const auto wall = thinnestWall(part, 0.005);
    EXPECT_FALSE(wall) << wall->thickness << " m, direction " << i;
  }
}

TEST(ThinWalls, SaysNothingOfAPressThatIsNone) {
  const brep::Model thin(plate(2));
  for (const double depth : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    EXPECT_FALSE(thinnestWall(thin, depth)) << depth;
}

}  // namespace
}  // namespace hapticd
