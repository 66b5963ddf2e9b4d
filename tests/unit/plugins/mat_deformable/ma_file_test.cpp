// SPDX-License-Identifier: MIT
#include "mat_deformable/ma_file.hpp"

#include <gtest/gtest.h>

#include "traced_shape/model_file.hpp"

namespace hapticd {
namespace {

std::string complaintOf(const std::string& text) {
  try {
    parseMa(text, "body.ma");
  } catch (const ModelFileError& e) {
    return e.what();
  }
  return "";
}

TEST(MaFile, ReadsVerticesEdgesAndTriangles) {
  const medial::MeshData mesh = parseMa(
      "# made by hand\n4 1 1\r\nv 0 0 0 0.01\nv +0.1 0 0 2e-2\n\nv 0 .1 0 0.01 1 0\nv 0 0 -0.1 0\ne 0 3\nf 0 1 2\n",
      "body.ma");
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[1].center, Eigen::Vector3d(.1, 0, 0));
  EXPECT_EQ(mesh.vertices[1].radius, .02);
  EXPECT_EQ(mesh.edges, (std::vector<std::array<int, 2>>{{0, 3}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}}));
}

TEST(MaFile, SaysWhichLineIsWrongAndWhatWasExpected) {
  EXPECT_EQ(complaintOf(""),
            "body.ma:1: the file is empty; the first line must have the numbers of vertices, edges and triangles");
  EXPECT_NE(complaintOf("v 0 0 0 1\n").find("body.ma:1: 'v'; the first line must have three whole numbers"),
            std::string::npos);
  EXPECT_NE(complaintOf("3 0\n").find("body.ma:1: too few numbers; the first line must have three whole numbers"),
            std::string::npos);
  EXPECT_NE(complaintOf("3 -1 0\n").find("body.ma:1: -1 elements of one kind; expected 0 to 10000000"),
            std::string::npos);
  EXPECT_NE(complaintOf("20000000 0 0\n").find("body.ma:1: 20000000 elements of one kind"), std::string::npos);
  EXPECT_NE(complaintOf("0 0 0\n").find("body.ma:1: there are no vertices"), std::string::npos);
  EXPECT_NE(complaintOf("1 0 0\nv 0 0 0 -1\n").find("is not a vertex; expected v x y z r"), std::string::npos);
  EXPECT_NE(complaintOf("1 0 0\nv 0 0 nan 1\n").find("body.ma:2: "), std::string::npos);
  EXPECT_NE(complaintOf("1 0 0\nv 1e308 0 0 1\n").find("is not a vertex; expected v x y z r"), std::string::npos);
  EXPECT_NE(complaintOf("2 1 0\nv 0 0 0 1\nv 1 0 0 1\ne 0 2\n")
                .find("does not name vertices; expected e i j: different vertices "
                      "from 0 to 1"),
            std::string::npos);
  EXPECT_NE(complaintOf("3 0 1\nv 0 0 0 1\nv 1 0 0 1\nv 2 0 0 1\nf 0 1 1\n")
                .find("body.ma:5: 'f 0 1 1' does not name vertices; expected f i j k"),
            std::string::npos);
  EXPECT_NE(complaintOf("2 0 0\nv 0 0 0 1\n").find("1 vertex is in the file, but the first line says 2"),
            std::string::npos);
  EXPECT_NE(complaintOf("1 0 0\nv 0 0 0 1\nx 1\n").find("body.ma:3: 'x': a line must begin with v, e, f or #"),
            std::string::npos);
}

TEST(MaFile, RepeatsNoControlCharactersOfAFile) {
  for (const char* text : {"1 0 0\nv 0 0 0 1\n\x1b[31mred\n", "\x1b]0;title\a 1 1\n", "1 0 0\nv 0 0 0 1\n\xff\xfe\n"})
    for (const char c : complaintOf(text)) EXPECT_TRUE(c >= ' ' && c <= '~') << complaintOf(text);
}

TEST(MaFile, ListsAllProblemsButNotThousands) {
  std::string text = "1 0 0\n";
  for (int i = 0; i < 1000; ++i) text += "v a b c d\n";
  const std::string complaint = complaintOf(text);
  EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 19);
}

}  // namespace
}  // namespace hapticd
