// SPDX-License-Identifier: MIT
/// Colours of OBJ and PLY files are those of the same places of the part, whatever was repaired.
#include "mesh_import/mesh_colours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "cube.hpp"
#include "kernels/part/file.hpp"

namespace hapticd::importing {
namespace {

constexpr std::uint32_t kRed = 0xff0000ffu, kGreen = 0xff00ff00u, kBlue = 0xffff0000u;
constexpr const char* kMtl =
    "newmtl red\nKd 1 0 0\n\nnewmtl deep green\n  Kd 0 1 0\nKs 1 1 1\nnewmtl grey\nKd 0.2\nnewmtl odd\nKd spectral "
    "x.rfl\n"
    "newmtl photo\nKd 0 0 1\nmap_Kd photo.png\n";

using Files = std::map<std::string, std::string>;

ReadBeside readerOf(const Files& files) {
  return [&files](const std::string& name) -> Result<std::string> {
    const auto found = files.find(name);
    if (found == files.end()) return Error{"cannot be read: No such file or directory"};
    return found->second;
  };
}

MeshFile read(const std::string& text, const Files& files = {}) {
  const auto mesh = parseObjMesh(text, "x.obj", readerOf(files));
  EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error());
  return mesh ? *mesh : MeshFile{};
}

std::string all(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// The number of triangles of each colour.
std::map<std::uint32_t, int> counted(const std::vector<std::array<std::uint32_t, 3>>& colours) {
  std::map<std::uint32_t, int> counts;
  for (const auto& c : colours) {
    EXPECT_TRUE(c[0] == c[1] && c[1] == c[2]);
    ++counts[c[0]];
  }
  return counts;
}

/// Each corner of a part of the unit cube has the colour of its place: the sum of what each axis gives.
void expectPlaces(const brep::Part& part) {
  ASSERT_EQ(part.colours.size(), part.triangles.size());
  for (std::size_t t = 0; t < part.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const brep::Point& p = part.points[part.triangles[t].corner[k]];
      EXPECT_EQ(part.colours[t].corner[k], colourWord(p[0], p[1], p[2])) << t << " " << k;
    }
}

TEST(MeshColours, AWordHasTheBytesOfAColour) {
  EXPECT_EQ(colourWord(1, 0, 0), kRed);
  EXPECT_EQ(colourWord(-1, 7, 0), kGreen);
  EXPECT_EQ(colourWord(0, 0, 0), 0xff000000u) << "black is no missing colour";
  EXPECT_EQ(colourWord(0.5, 0.5, 0.5), 0xff808080u);
  EXPECT_EQ(colourWord(NAN, 0, 0), 0u);
}

TEST(MeshColours, AreThoseOfTheMaterials) {
  const Files files{{"a.mtl", kMtl}};
  const MeshFile mesh = read(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl red\nf 1 3 2\nf 2 3 1\nusemtl  deep green \nf 1 2 4\nmtllib "
      "a.mtl\n"
      "usemtl grey\nf 1 5 2\nv 3 3 3\n",
      files);
  ASSERT_EQ(mesh.colours.size(), 5u);
  EXPECT_EQ(counted(mesh.colours), (std::map<std::uint32_t, int>{{0, 1}, {kRed, 2}, {kGreen, 1}, {0xff333333u, 1}}));
  EXPECT_EQ(mesh.colours[4][0], 0xff333333u) << "of a face that stands before its point";
  EXPECT_TRUE(mesh.remarks.empty()) << all(mesh.remarks);
}

TEST(MeshColours, WhatIsMissingIsTold) {
  const std::string faces = "usemtl red\nf 1 2 3\n", points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto told = [&](const std::string& text, const Files& files) {
    const MeshFile mesh = read(points + text, files);
    EXPECT_TRUE(mesh.colours.empty());
    return all(mesh.remarks);
  };
  EXPECT_EQ(told("mtllib x y.mtl\n" + faces, {}),
            "the file of materials 'x y.mtl': cannot be read: No such file or directory; its colours are missing\n");
  EXPECT_EQ(told(faces, {}), "1 material has no colour, such as 'red': the file names no file of materials (mtllib)\n");
  EXPECT_EQ(
      told("mtllib a.mtl\nusemtl odd\nf 1 2 3\n", {{"a.mtl", kMtl}}),
      "1 material has no colour, such as 'odd': expected newmtl with Kd and three numbers in the file of materials\n");
  EXPECT_EQ(told("mtllib a.mtl\nf 1 2 3\n", {}), "") << "nothing uses it";
  EXPECT_EQ(told("mtllib a.mtl\nusemtl\nf 1 2 3\n", {}), "") << "a material without a name is none";
  const MeshFile photo = read(points + "mtllib a.mtl\nusemtl photo\nf 1 2 3\n", {{"a.mtl", kMtl}});
  EXPECT_EQ(counted(photo.colours), (std::map<std::uint32_t, int>{{kBlue, 1}}));
  EXPECT_EQ(all(photo.remarks), "1 material has a picture (map_Kd), which is not kept: only the colour (Kd) is\n");
  EXPECT_TRUE(parseObjMesh(points + "mtllib a.mtl\n" + faces, "x.obj")->remarks.empty()) << "nobody asks for colours";
}

TEST(MeshColours, NoFileOutsideOfTheFolderIsAskedFor) {
  std::vector<std::string> asked;
  const ReadBeside note = [&](const std::string& name) -> Result<std::string> {
    asked.push_back(name);
    return std::string(kMtl);
  };
  const auto remarksOf = [&](const std::string& line) {
    const auto mesh =
        parseObjMesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib " + line + "\nusemtl red\nf 1 2 3\n", "x.obj", note);
    return all(mesh->remarks);
  };
  for (const char* name : {"../a.mtl", "/etc/a.mtl", "b/../../a.mtl", "..\\a.mtl", "C:\\a.mtl", "c:a.mtl",
                           "\\\\host\\a.mtl", "..", "b/..", "a\x01.mtl"})
    EXPECT_NE(remarksOf(name).find("is not read, because it is not in the folder of the mesh"), std::string::npos)
        << name;
  EXPECT_TRUE(asked.empty());
  for (const char* name : {"a.mtl b.mtl a.mtl", "my a.mtl", "b\\c.MTL", "..a.mtl", "b/..c/d.mtl"})
    EXPECT_EQ(remarksOf(name), "") << name;
  EXPECT_EQ(asked, (std::vector<std::string>{"a.mtl", "b.mtl", "my a.mtl", "b/c.MTL", "..a.mtl", "b/..c/d.mtl"}));
  asked.clear();
  std::string many;
  for (int i = 0; i < 1000; ++i) many += std::to_string(i) + ".mtl ";
  EXPECT_EQ(remarksOf(many), "only the first 16 of 1000 files of materials were read\n");
  EXPECT_EQ(asked.size(), 16u);
}

TEST(MeshColours, AnyBytesAreNoMaterials) {
  for (const std::string& text :
       {std::string("\0newmtl red\nKd", 14), std::string("newmtl"), std::string("Kd 1 1 1\nnewmtl red\nKd nan 1 1\n"),
        std::string("\xff\xfen\0e\0", 6), std::string("newmtl red\nKd 1 1\n")})
    EXPECT_TRUE(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a\nusemtl red\nf 1 2 3\n", {{"a", text}}).colours.empty())
        << text;
}

/// A cube whose vertices have the colour of their place.
std::string plyCube(const char* format, const std::string& faces, std::size_t count) {
  std::string text =
      std::string("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n") +
      "property " + format + " red\nproperty " + format + " green\nproperty " + format +
      " blue\nproperty uchar alpha\n" + "element face " + std::to_string(count) +
      "\nproperty list uchar int vertex_indices\nend_header\n";
  const int full = std::strcmp(format, "uchar") == 0 ? 255 : std::strcmp(format, "ushort") == 0 ? 65535 : 1;
  for (int i = 0; i < 8; ++i) {
    const int place[] = {i & 1, i >> 1 & 1, i >> 2};
    for (const int value : place) text += std::to_string(value) + " ";
    for (const int value : place) text += std::to_string(full * value) + " ";
    text += "255\n";
  }
  return text + faces;
}

constexpr const char* kPlyFaces = "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

TEST(MeshColours, AreThoseOfTheVerticesOfObj) {
  std::string text;
  for (int i = 0; i < 8; ++i) {
    const std::string place = std::to_string(i & 1) + " " + std::to_string(i >> 1 & 1) + " " + std::to_string(i >> 2);
    text += "v " + place + " " + place + "\n";
  }
  const std::string faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  MeshReport report;
  expectPlaces(meshPart(*parseObjMesh(text + faces, "x.obj"), {}, "x.obj", report));
  EXPECT_EQ(report.coloured, 12u);
  EXPECT_TRUE(parseObjMesh("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n", "x.obj")->colours.empty()) << "weights";
  const auto read = [](const std::string&) -> Result<std::string> { return std::string("newmtl red\nKd 1 0 0\n"); };
  const auto mesh = parseObjMesh("mtllib a.mtl\nusemtl red\n" + text + faces, "x.obj", read);
  EXPECT_EQ(counted(mesh->colours), (std::map<std::uint32_t, int>{{kRed, 12}})) << "a material comes first";
}

TEST(MeshColours, AreThoseOfTheVerticesOfPly) {
  for (const char* format : {"uchar", "ushort", "float", "double"}) {
    const auto mesh = parsePlyMesh(plyCube(format, kPlyFaces, 6), "x.ply");
    ASSERT_TRUE(mesh) << mesh.error();
    MeshReport report;
    const brep::Part part = meshPart(*mesh, {}, "x.ply", report);
    EXPECT_EQ(report.coloured, 12u);
    expectPlaces(part);
  }
}

TEST(MeshColours, FollowTheirPlacesThroughRepairs) {
  // a face twice, one that looks inward, and one of zero area
  const std::string faces = "4 0 2 3 1\n3 0 2 3\n3 0 0 1\n4 4 5 7 6\n4 4 5 1 0\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
  const auto mesh = parsePlyMesh(plyCube("uchar", faces, 8), "x.ply");
  ASSERT_TRUE(mesh) << mesh.error();
  MeshReport report;
  const brep::Part part = meshPart(*mesh, {1e-3}, "x.ply", report);
  EXPECT_GT(report.flipped, 0u);
  EXPECT_EQ(report.duplicates, 1u);
  EXPECT_EQ(report.degenerate, 1u);
  EXPECT_EQ(report.coloured, 12u);
  brep::Part large = part;
  for (brep::Point& p : large.points)
    for (double& x : p) x *= 1e3;
  expectPlaces(large);
}

TEST(MeshColours, OfAFaceComeBeforeThoseOfItsVertices) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "red\n"
      "property uchar green\nproperty uchar blue\nelement face 2\nproperty uchar red\nproperty list uchar int "
      "vertex_indices\n"
      "property uchar green\nproperty uchar blue\nend_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n1 1 0 255 0 0\n0 1 0 255 0 "
      "0\n";
  const auto mesh = parsePlyMesh(head + "0 4 0 1 2 3 0 255\n0 3 0 1 2 255 0\n", "x.ply");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_EQ(counted(mesh->colours), (std::map<std::uint32_t, int>{{kBlue, 2}, {kGreen, 1}}));
}

TEST(MeshColours, APlyFileWithoutAllThreeHasNone) {
  const auto mesh = parsePlyMesh(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "red\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 255\n1 0 0 255\n0 1 0 255\n3 0 1 2\n",
      "x.ply");
  ASSERT_TRUE(mesh) << mesh.error();
  EXPECT_TRUE(mesh->colours.empty());
}

TEST(MeshColours, ASliverTakesTheColourOfTheTriangleThatItCuts) {
  // the red square's lower edge has a point in its middle, which a green triangle without width closes
  const MeshFile mesh = read(
      "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 0 0\nv 0 -2 0\nv 2 -2 0\nusemtl red\nf 1 2 3\nf 1 3 4\n"
      "usemtl deep green\nf 1 5 2\nusemtl photo\nf 1 6 5\nf 5 6 7\nf 5 7 2\n",
      {{"a.mtl", kMtl}});
  MeshReport report;
  const brep::Part part = meshPart(mesh, {}, "x.obj", report);
  EXPECT_EQ(report.slivers, 1u);
  std::map<std::uint32_t, int> counts;
  for (const brep::CornerColours& c : part.colours) ++counts[c.corner[0]];
  EXPECT_EQ(counts, (std::map<std::uint32_t, int>{{kRed, 3}, {kBlue, 3}}));
}

TEST(MeshColours, EachBodyKeepsItsOwn) {
  const std::string second = "f 12 11 10 9\nf 13 14 15 16\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\n";
  std::string text = std::string("mtllib a.mtl\no one\n") + kCube + "o two\nusemtl red\n";
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string(3 + (i % 4 == 1 || i % 4 == 2)) + " " + std::to_string(i % 4 / 2) + " " +
            std::to_string(i / 4) + "\n";
  const MeshFile mesh = read(text + second, {{"a.mtl", kMtl}});
  MeshReport report;
  const brep::Part part = meshPart(mesh, {}, "x.obj", report);
  brep::checkPart(part);
  EXPECT_EQ(report.coloured, 12u);
  ASSERT_EQ(part.bodies.size(), 2u);
  ASSERT_EQ(part.colours.size(), 24u);
  for (std::uint32_t t = 0; t < 24; ++t) EXPECT_EQ(part.colours[t].corner[0], t < 12 ? 0u : kRed) << t;
}

TEST(MeshColours, ComeBackFromTheFile) {
  const auto mesh = parsePlyMesh(plyCube("float", kPlyFaces, 6), "x.ply");
  MeshReport report;
  const brep::Part part = meshPart(*mesh, {}, "x.ply", report);
  std::string file = brep::writePart(part);
  const brep::Part back = brep::readPart(std::as_bytes(std::span(file)), "x");
  expectPlaces(back);
  // a reader that does not know the section passes it over, as this one does a section of another name
  file.replace(file.find("\"colour\""), 8, "\"colouR\"");
  EXPECT_TRUE(brep::readPart(std::as_bytes(std::span(file)), "x").colours.empty());
}

TEST(MeshColours, ThereAreAsManyAsTriangles) {
  const auto mesh = parsePlyMesh(plyCube("float", kPlyFaces, 6), "x.ply");
  MeshReport report;
  brep::Part part = meshPart(*mesh, {}, "x.ply", report);
  part.colours.pop_back();
  try {
    brep::writePart(part);
    FAIL() << "was written";
  } catch (const brep::PartError& error) {
    EXPECT_STREQ(error.what(),
                 "colours: there are those of 11 triangles, expected 12, as many as the part has, or none");
  }
}

}  // namespace
}  // namespace hapticd::importing
