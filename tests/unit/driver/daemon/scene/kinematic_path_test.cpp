// SPDX-License-Identifier: MIT
#include "scene/kinematic_path.hpp"

#include <gtest/gtest.h>

namespace hapticd::scene {
namespace {

std::vector<PathPoint> good(const std::string& text) {
  Problems problems;
  const auto points = parseKinematicPath(text, "p.csv", problems);
  EXPECT_TRUE(problems.empty()) << problems.front().text();
  return points;
}

std::string firstProblem(const std::string& text) {
  Problems problems;
  parseKinematicPath(text, "p.csv", problems);
  return problems.empty() ? "" : problems.front().text();
}

TEST(KinematicPath, ReadsPosesAndNormalisesQuaternions) {
  const auto points =
      good("# made by hand\r\n t, x, y, z, qw, qx, qy, qz\r\n0, 1, 2, 3, 1.0005, 0, 0, 0\r\n\r\n0.5,0,0,0,0,1,0,0\n");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].pose.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(points[0].pose.orientation.w(), 1);
  EXPECT_EQ(points[1].t, 0.5);
  EXPECT_EQ(points[1].pose.orientation.x(), 1);
}

TEST(KinematicPath, TakesPositionsAlone) {
  const auto points = good("t,x,y,z\n0,1,2,3");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_TRUE(points[0].pose.orientation.isApprox(Eigen::Quaterniond::Identity()));
}

TEST(KinematicPath, NamesLineColumnAndReason) {
  EXPECT_EQ(firstProblem("t,x,y,z\n0,0,0,0\n0,0,0,0\n"),
            "p.csv:3:1: t: 0 does not grow from row to row, expected more than the 0 of the row before");
  EXPECT_EQ(firstProblem("t,x,y,z\n0,0,inf,0\n"), "p.csv:2:5: y: \"inf\" is not valid, expected a finite number");
  EXPECT_EQ(firstProblem("t,x,y,z\n0,0,0,0,9\n"),
            "p.csv:2:1: 5 columns, expected 4; write decimals with a point: 0.5, not 0,5");
  EXPECT_EQ(firstProblem("t,x,y,z\n0,0,0,1e300\n"),
            "p.csv:2:7: z: \"1e300\" is not valid, expected a finite number of at most 1e+06");
  EXPECT_EQ(firstProblem("t,x,y,z\n"),
            "p.csv:1:1: there are no rows, expected a header t,x,y,z,qw,qx,qy,qz or t,x,y,z and at least one row");
}

TEST(KinematicPath, ReportsEveryProblemOfAFile) {
  Problems problems;
  parseKinematicPath(
      "t,x,y,z,qw,qx,qy,qz\n0,a,0,b,1,0,0,0\n1,0,0,0,2,0,0,0\n1,0,0,0,1,0,0,0\n2,0,0,0,1,1,0,0\n0.5,0,c,0,1,0,0,0\n",
      "p.csv", problems);
  std::string all;
  for (const document::Problem& problem : problems) all += problem.text() + "\n";
  for (const char* one :
       {"p.csv:2:3: x: \"a\"", "p.csv:2:7: z: \"b\"", "p.csv:3:1: qw: the quaternion has length 2",
        "p.csv:4:1: t: 1 does not grow", "p.csv:5:1: qw:", "p.csv:6:7: y: \"c\"",
        "p.csv:6:1: t: 0.5 does not grow from row to row, expected more than the 2 of the row before"})
    EXPECT_NE(all.find(one), std::string::npos) << one << "\n" << all;
  EXPECT_EQ(problems.size(), 7u) << all;
}

TEST(KinematicPath, StopsReportingAFileThatIsWrongThroughout) {
  std::string text = "t,x,y,z\n";
  for (int i = 0; i < 100000; ++i) text += "what is this\n";
  Problems problems;
  parseKinematicPath(text, "p.csv", problems);
  EXPECT_LE(problems.size(), 20u);
  EXPECT_GE(problems.size(), 1u);
}

}  // namespace
}  // namespace hapticd::scene
