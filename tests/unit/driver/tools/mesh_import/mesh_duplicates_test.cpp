// SPDX-License-Identifier: MIT
/// Triangles that lie on one another, in files and after slivers were taken in.
#include <gtest/gtest.h>

#include <string>

#include "cube.hpp"

namespace hapticd::importing {
namespace {

TEST(Duplicates, OfTheSameSideAndOfTheOtherLeaveASolid) {
  for (const char* again : {"f 1 2 6\n", "f 6 2 1\n"}) {
    MeshReport report;
    partOf(std::string(kCube) + again, report);
    EXPECT_EQ(report.duplicates, 1u) << again;
    EXPECT_EQ(report.back_to_back, 0u) << again;
    EXPECT_TRUE(report.closed) << again;
    EXPECT_NEAR(report.volume, 1, 1e-15) << again;
  }
}

TEST(Duplicates, AWallBetweenTwoBodiesIsNoFace) {
  // Beside the cube, on its side 2 3 7 6: a second one that has this side as well, and looks into the first.
  const std::string second =
      "v 2 0 0\nv 2 1 0\nv 2 1 1\nv 2 0 1\n"
      "f 3 10 9 2\nf 6 12 11 7\nf 2 9 12 6\nf 9 10 11 12\nf 10 3 7 11\nf 7 3 2\nf 6 7 2\n";
  MeshReport report;
  partOf(std::string(kCube) + second, report);
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 2, 1e-15);
  EXPECT_EQ(report.back_to_back, 4u);
  EXPECT_EQ(report.non_manifold, 0u);
}

TEST(Duplicates, ASheetOfTwoSidesKeepsOne) {
  MeshReport report;
  partOf("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 3 2 1\nf 4 3 1\n", report);
  EXPECT_EQ(report.triangles, 2u);
  EXPECT_EQ(report.duplicates, 2u);
  EXPECT_EQ(report.back_to_back, 0u);
}

TEST(Duplicates, AFlangeOfTheFileStays) {
  MeshReport report;
  partOf(std::string(kCube) + "v 0.5 0 2\nf 5 6 9\nf 9 6 5\n", report);
  EXPECT_EQ(report.triangles, 13u);
  EXPECT_EQ(report.duplicates, 1u);
  EXPECT_EQ(report.back_to_back, 0u);
}

TEST(Duplicates, AFoldWhoseSliverIsTakenInEnclosesNothing) {
  // The top is a fan about 9, but its triangle 9 5 6 goes on to 10 and comes back; a sliver 5 10 9 closes the fold.
  std::string text = kCube;
  text.replace(text.find("f 5 6 7 8"), 9,
               "v 0.5 0.5 1\nv 0.75 0.75 1\nf 6 7 9\nf 7 8 9\nf 8 5 9\nf 10 5 6\nf 10 6 9\nf 5 10 9");
  MeshReport report;
  partOf(text, report);
  EXPECT_EQ(report.slivers, 1u);
  EXPECT_EQ(report.back_to_back, 2u);
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 1, 1e-15);
  EXPECT_EQ(report.triangles, 14u);
}

}  // namespace
}  // namespace hapticd::importing
