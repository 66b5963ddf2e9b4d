// SPDX-License-Identifier: MIT
/// Objects of OBJ files.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cube.hpp"
#include "mesh_import/mesh_crossings.hpp"

namespace hapticd::importing {
namespace {

/// A cube whose points are moved along x, and all axes by `aside`; `first` is the number of its first point.
std::string cubeAt(double x, int first, bool lid = true, double aside = 0) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    const int bit = i % 4;
    text += "v " + std::to_string(x + aside + (bit == 1 || bit == 2 ? 1 : 0)) + " " +
            std::to_string(aside + (bit >= 2 ? 1 : 0)) + " " + std::to_string(aside + (i >= 4 ? 1 : 0)) + "\n";
  }
  const int faces[6][4] = {{4, 3, 2, 1}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}, {5, 6, 7, 8}};
  for (int f = 0; f < (lid ? 6 : 5); ++f) {
    text += "f";
    for (const int corner : faces[f]) text += " " + std::to_string(corner + first - 1);
    text += "\n";
  }
  return text;
}

TEST(MeshImport, MakesABodyOfEachObject) {
  MeshReport report;
  const brep::Part part = partOf("o Brick\n" + cubeAt(0, 1) + "o An open box\n" + cubeAt(3, 9, false), report);
  ASSERT_EQ(part.bodies.size(), 2u);
  EXPECT_EQ(part.names, (std::vector<std::string>{"x", "Brick", "An open box"}));
  EXPECT_EQ(part.bodies[0].flags, brep::kClosed) << "the hole of the other object does not open this one";
  EXPECT_EQ(part.bodies[1].flags, 0u);
  ASSERT_EQ(part.instances.size(), 3u);
  EXPECT_EQ(part.instances[0].body, brep::kNone) << "the file as a whole can still be named";
  EXPECT_EQ(part.instances[2].parent, 0u);
  EXPECT_FALSE(report.closed);
  EXPECT_EQ(report.triangles, 22u);
  ASSERT_EQ(report.bodies.size(), 2u);
  EXPECT_EQ(report.bodies[0].name, "Brick");
}

TEST(MeshImport, ObjectsThatTouchStayApart) {
  MeshReport report;
  const brep::Part part = partOf("o a\n" + cubeAt(0, 1) + "o b\n" + cubeAt(1, 9), report);
  EXPECT_EQ(part.bodies.size(), 2u);
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 2, 1e-12);
  EXPECT_EQ(report.overlaps.pairs, 0u);
}

TEST(MeshImport, ObjectsThatPassThroughEachOtherAreTold) {
  MeshReport report;
  const brep::Part part = partOf("o a\n" + cubeAt(0, 1) + "o b\n" + cubeAt(0, 9, true, 0.25), report);
  EXPECT_EQ(part.bodies.size(), 2u);
  EXPECT_EQ(report.crossings.pairs, 0u) << "each is sound";
  EXPECT_GT(report.overlaps.pairs, 0u);
  ASSERT_EQ(part.warnings.size(), 1u);
  EXPECT_EQ(part.warnings[0].rfind("2 bodies pass through each other: ", 0), 0u) << part.warnings[0];
}

TEST(MeshImport, ObjectsThatCloseEachOtherAreOneBody) {
  MeshReport report;
  const brep::Part part = partOf("o box\n" + cubeAt(0, 1, false) + "o lid\nf 5 6 7 8\n", report);
  EXPECT_EQ(part.bodies.size(), 1u);
  EXPECT_TRUE(report.closed);
  ASSERT_EQ(report.remarks.size(), 1u);
  EXPECT_EQ(report.remarks[0], "the object 'lid' is one body with 'box', because their borders share edges");
}

TEST(MeshImport, SaysThatGroupsAreNotKept) {
  MeshReport report;
  const brep::Part part = partOf("o one\ng a\n" + cubeAt(0, 1) + "g b\n" + cubeAt(3, 9), report);
  EXPECT_EQ(part.bodies.size(), 1u);
  EXPECT_EQ(part.names, std::vector<std::string>{"x"}) << "a single object has the name of the file";
  ASSERT_EQ(report.remarks.size(), 1u);
  EXPECT_EQ(report.remarks[0].rfind("the file has 2 groups (g), which are not kept", 0), 0u);
}

/// Triangles that all cross each other would take minutes if every pair were tried.
TEST(MeshImport, TriesNoMoreCrossingsThanASecondsWork) {
  constexpr std::uint32_t kTriangles = 3000;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::uint32_t, 3>> corners;
  std::vector<std::uint32_t> shell;
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const double angle = 0.001 * i;
    for (const double turn : {0.0, 2.0, 4.0})
      points.emplace_back(std::cos(turn), std::sin(turn) * std::cos(angle),
                          std::sin(turn) * std::sin(angle) + 1e-4 * i);
    corners.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    shell.push_back(i);
  }
  const Crossings found = crossingsOf(points, corners, shell, kTriangles);
  EXPECT_FALSE(found.all_tried);
  EXPECT_GT(found.pairs, 0u);
}

}  // namespace
}  // namespace hapticd::importing
