// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "mesh_import/mesh_file.hpp"

namespace hapticd::importing {
namespace {

std::string errorIn(const Result<MeshFile>& mesh) {
  return mesh ? "" : mesh.error();
}

std::vector<std::string> linesOf(const std::string& error) {
  std::vector<std::string> lines;
  std::istringstream in(error);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(MeshImport, TellsAllWrongLinesAtOnce) {
  const auto obj = linesOf(errorIn(parseObjMesh("v 0 0 0\nv 0 zero 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\nf 1 2\n", "x.obj")));
  ASSERT_EQ(obj.size(), 3u);
  EXPECT_EQ(obj[0].rfind("x.obj:2: 'v 0 zero 0'", 0), 0u);
  EXPECT_EQ(obj[1], "x.obj:5: the face names the point '9'; expected 1 to 3");
  EXPECT_EQ(obj[2], "x.obj:6: the face has 2 points; expected f and at least three");
  const auto stl =
      linesOf(errorIn(parseStlMesh("solid\nfacet\nvertex 0 0 a\nvertex 1 0 0\nvertex 0 1 b\nendfacet\n"
                                   "facet\nvertex 0 0 0\nendfacet\nendsolid\n",
                                   "x.stl")));
  ASSERT_EQ(stl.size(), 3u);
  EXPECT_EQ(stl[1].rfind("x.stl:5: 'vertex 0 1 b'", 0), 0u);
  EXPECT_EQ(stl[2].rfind("x.stl:7: the facet has 1 corner", 0), 0u);
  const auto ply = linesOf(
      errorIn(parsePlyMesh("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
                           "0 0 0\n1 0\n0 one 0\n3 0 1 2\n3 0 1 7\n",
                           "x.ply")));
  ASSERT_EQ(ply.size(), 3u);
  EXPECT_EQ(ply[0], "x.ply:11: vertex 1 (from 0) of 3: the line ends before the value of the property z");
  EXPECT_EQ(ply[1], "x.ply:12: vertex 2 (from 0) of 3: 'one' is not a number; expected the value of the property y");
  EXPECT_EQ(ply[2].rfind("x.ply:14: face 1 (from 0) of 2: its vertex 7 is out of range", 0), 0u);
}

TEST(MeshImport, SaysThatABinaryStlIsEmpty) {
  EXPECT_EQ(errorIn(parseStlMesh(std::string(84, '\0'), "x.stl")),
            "x.stl: the file has no triangles; it is an empty binary STL");
}

TEST(MeshImport, CountsTheWrongLinesBeyondTwenty) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "v 0 0\n";
  const auto lines = linesOf(errorIn(parseObjMesh(text, "x.obj")));
  ASSERT_EQ(lines.size(), 21u);
  EXPECT_EQ(lines[20], "x.obj: 80 more lines are wrong");
}

/// Comments, polygons, several loops, and no facets at all.
TEST(MeshImport, ReadsTextStlThatOthersAccept) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const std::string corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n",
                    loop = "outer loop\n" + corners + "endloop\n";
  for (const std::string& text :
       {"solid\n" + corners + corners + "endsolid", "solid\n" + loop + "outer loop\n" + corners + "endloop\nendsolid",
        "solid\nfacet\n" + loop + loop + "endfacet\nendsolid",
        "# vertex of a solid\nsolid\n// facet\n" + facet + "; vertex 1\n" + facet + "endsolid"}) {
    const auto mesh = parseStlMesh(text, "x.stl");
    ASSERT_TRUE(mesh) << mesh.error();
    EXPECT_EQ(mesh->corners.size(), 2u) << text;
    EXPECT_TRUE(mesh->remarks.empty());
  }
  const auto square =
      parseStlMesh("solid\nfacet\nouter loop\n" + corners + "vertex -1 1 0\nendloop\nendfacet\nendsolid", "x.stl");
  ASSERT_TRUE(square) << square.error();
  EXPECT_EQ(square->corners.size(), 2u);
  EXPECT_EQ(square->remarks[0], "1 facet has more than three corners and became triangles");
}

}  // namespace
}  // namespace hapticd::importing
