// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>

#include "kernels/brep/part_check.hpp"
#include "mesh_import/mesh_part.hpp"

namespace hapticd::importing {
namespace {

const char* const kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

brep::Part partOf(const std::string& obj, MeshReport& report, const MeshOptions& options = {}) {
  const auto mesh = parseObjMesh(obj, "x.obj");
  EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error());
  brep::Part part = meshPart(*mesh, options, "x.obj", report);
  brep::checkPart(part);
  return part;
}

TEST(MeshImport, MakesAClosedBodyOfACube) {
  MeshReport report;
  const brep::Part part = partOf(kCube, report, {0.001, 0.5});
  EXPECT_EQ(part.triangles.size(), 12u);
  EXPECT_EQ(part.points.size(), 8u);
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 1e-9, 1e-21);
  EXPECT_EQ(part.bodies[0].smooth_angle, 0.5);
  EXPECT_EQ(part.bodies[0].flags, brep::kClosed);
  EXPECT_TRUE(linesOf(report).empty());
}

TEST(MeshImport, TurnsAClosedSurfaceOutward) {
  std::string inside_out = kCube;
  for (std::size_t at = inside_out.find("f "); at != std::string::npos; at = inside_out.find("f ", at + 1)) {
    std::swap(inside_out[at + 2], inside_out[at + 8]);
    std::swap(inside_out[at + 4], inside_out[at + 6]);
  }
  MeshReport report;
  partOf(inside_out, report);
  EXPECT_EQ(report.flipped, 12u);
  EXPECT_NEAR(report.volume, 1, 1e-15);
}

TEST(MeshImport, RepairsAndReportsWhatItFinds) {
  MeshReport report;
  std::string text = std::string(kCube) + "f 2 3 4\nf 1 1 2\nv 0.5 0 0\nf 1 9 2\n";  // again, empty, and flat
  text.replace(text.find("f 5 6 7 8"), 9, "f 8 7 6 5");                              // one side turned round
  partOf(text, report);
  EXPECT_EQ(report.duplicates, 1u);
  EXPECT_EQ(report.degenerate, 2u);
  EXPECT_EQ(report.flipped, 2u);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.points, 8u);
}

TEST(MeshImport, SeesHolesAndEdgesOfThreeTriangles) {
  std::string open = kCube;
  open.erase(open.find("f 5 6 7 8"), 10);
  MeshReport report;
  partOf(open, report);
  EXPECT_FALSE(report.closed);
  EXPECT_EQ(report.holes, 1u);
  EXPECT_EQ(report.free_edges, 4u);
  EXPECT_EQ(linesOf(report)[0], "1 hole with 4 free edges");

  MeshReport fin;
  const brep::Part part = partOf(std::string(kCube) + "v 2 0.5 0.5\nf 2 3 9\n", fin);
  EXPECT_EQ(fin.non_manifold, 1u);
  EXPECT_EQ(fin.free_edges, 2u);
  EXPECT_FALSE(fin.closed);
  EXPECT_EQ(part.triangles.size(), 13u);
}

std::string errorOf(const Result<MeshFile>& mesh) {
  return mesh ? "" : mesh.error();
}

TEST(MeshImport, SaysWhereAFileIsWrong) {
  EXPECT_EQ(errorOf(parseObjMesh("v 0 0\n", "x.obj")), "x.obj:1: expected v x y z, finite numbers");
  EXPECT_EQ(errorOf(parseObjMesh("v 0 0 0\nf 1 2 3\n", "x.obj")), "x.obj:2: point '2', expected 1 to 1");
  EXPECT_EQ(errorOf(parseObjMesh("v 0 0 nan\n", "x.obj")), "x.obj:1: expected v x y z, finite numbers");
  EXPECT_EQ(errorOf(parseStlMesh("solid\nvertex 0 0 zero\n", "x.stl")),
            "x.stl:2: expected vertex x y z, finite numbers");
  EXPECT_EQ(errorOf(parsePlyMesh("ply\nformat odd 1.0\n", "x.ply")),
            "x.ply:2: unknown format, expected ascii, binary_little_endian or binary_big_endian");
  EXPECT_EQ(errorOf(parseMesh("", "x.foo")), "x.foo: the name is not that of a mesh, expected .obj, .stl or .ply");
  EXPECT_NE(errorOf(parsePlyMesh("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n", "x.ply")),
            "");
}

const char* const kPlyHead =
    "element vertex 4\nproperty float x\nproperty float y\nproperty uchar red\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";

TEST(MeshImport, ReadsPlyInAllThreeForms) {
  const float xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::int32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::string text = std::string("ply\nformat ascii 1.0\ncomment made by hand\n") + kPlyHead;
  for (const auto& p : xyz)
    text += std::to_string(p[0]) + " " + std::to_string(p[1]) + " 7 " + std::to_string(p[2]) + "\n";
  for (const auto& f : faces)
    text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
  const auto binary = [&](bool big) {
    std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\n" + kPlyHead;
    const auto put = [&](const void* value, std::size_t size) {
      std::string raw(static_cast<const char*>(value), size);
      out += big ? std::string(raw.rbegin(), raw.rend()) : raw;
    };
    for (const auto& p : xyz) {
      put(&p[0], 4), put(&p[1], 4);
      out += '\7';
      put(&p[2], 4);
    }
    for (const auto& f : faces) {
      out += '\3';
      for (const std::int32_t& i : f) put(&i, 4);
    }
    return out;
  };
  for (const std::string& bytes : {text, binary(false), binary(true)}) {
    const auto mesh = parsePlyMesh(bytes, "x.ply");
    ASSERT_TRUE(mesh) << mesh.error();
    MeshReport report;
    brep::checkPart(meshPart(*mesh, {}, "x.ply", report));
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.volume, 1.0 / 6, 1e-15);
  }
  EXPECT_NE(errorOf(parsePlyMesh(binary(false).substr(0, 250), "x.ply")), "");
}

/// Any bytes: an answer, never a crash. (tests/fuzz goes on with this for longer.)
TEST(MeshImport, SurvivesSpoiltFiles) {
  std::mt19937 random(3);
  std::string ply = std::string("ply\nformat binary_little_endian 1.0\n") + kPlyHead + std::string(400, '\1');
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = i % 2 == 0 ? ply : std::string(kCube);
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    const auto mesh = i % 2 == 0 ? parsePlyMesh(bytes, "x") : parseObjMesh(bytes, "x");
    if (!mesh) continue;
    MeshReport report;
    try {
      brep::checkPart(meshPart(*mesh, {}, "x", report));
    } catch (const std::exception&) {
    }
  }
}

}  // namespace
}  // namespace hapticd::importing
