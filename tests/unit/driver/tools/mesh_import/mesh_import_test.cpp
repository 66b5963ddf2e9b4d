// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cctype>
#include <random>

#include "cube.hpp"

namespace hapticd::importing {
namespace {

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

TEST(MeshImport, CountsTrianglesThatDifferFromTheFile) {
  // Four of six triangles are the wrong way round: the majority is kept first, and the whole turned outward then.
  const std::string pyramid =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 1\nf 4 3 2 1\nf 5 2 1\nf 5 3 2\nf 5 4 3\nf 5 1 4\n";
  MeshReport report;
  partOf(pyramid, report);
  EXPECT_EQ(report.flipped, 4u);
  EXPECT_GT(report.volume, 0);
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
  EXPECT_EQ(linesOf(report)[0], "1 hole with 4 free edges, around (0.5, 0.5, 1) m, 1.41 m wide");
  ASSERT_EQ(report.borders.size(), 1u);
  EXPECT_EQ(report.borders[0].edges, 4u);

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
  EXPECT_EQ(errorOf(parseObjMesh("v 0 0\n", "x.obj")),
            "x.obj:1: 'v 0 0' is not a point; expected v x y z, finite numbers");
  EXPECT_EQ(errorOf(parseObjMesh("v 0 0 0\nf 1 2 3\n", "x.obj")),
            "x.obj:2: the face names the point '2'; expected 1 to 1");
  EXPECT_EQ(errorOf(parseObjMesh("v 0 0 nan\n", "x.obj")),
            "x.obj:1: 'v 0 0 nan' is not a point; expected v x y z, finite numbers");
  EXPECT_EQ(errorOf(parseObjMesh("v 0 0 0\nf 1 2\33[2J 3\n", "x.obj")),
            "x.obj:2: the face names the point '2?[2J'; expected 1 to 1");
  EXPECT_EQ(errorOf(parseMesh("\xfe\xff\0#", "x.obj")),
            "x.obj: is text in UTF-16, expected UTF-8 or ASCII: save it again with that encoding");
  EXPECT_EQ(errorOf(parseMesh("", "x.stl")), "x.stl: is empty");
  EXPECT_EQ(errorOf(parseStlMesh("solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\n", "x.stl")),
            "x.stl:2: the file ends inside this facet, so it is cut off; expected endfacet");
  EXPECT_EQ(errorOf(parseStlMesh("solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendfacet\nendsolid", "x.stl")),
            "x.stl:2: the facet has 2 corners; expected three lines vertex x y z");
  EXPECT_EQ(
      errorOf(parsePlyMesh("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
                           "property float z\nend_header\n0 0 0\n",
                           "x.ply")),
      "x.ply:8: vertex 1 (from 0) of 2: the file ends here, but the header states more; the file is cut off, or the "
      "number in the header is wrong");
  EXPECT_EQ(errorOf(parsePlyMesh("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                 "end_header\n0 0\n",
                                 "x.ply")),
            "x.ply:6: the element vertex has no property z; expected x, y and z");
  EXPECT_EQ(errorOf(parseStlMesh("solid\nvertex 0 0 zero\n", "x.stl")),
            "x.stl:2: 'vertex 0 0 zero' is not a corner; expected vertex x y z, finite numbers\n"
            "x.stl:2: the facet has 1 corner; expected three lines vertex x y z");
  EXPECT_EQ(errorOf(parsePlyMesh("ply\nformat odd 1.0\n", "x.ply")),
            "x.ply:2: the format 'odd' is unknown; expected ascii, binary_little_endian or binary_big_endian");
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

/// Returns the area of all triangles.
double areaOf(const brep::Part& part) {
  double area = 0;
  for (const brep::Triangle& t : part.triangles) {
    const auto at = [&](std::size_t k) { return Eigen::Vector3d(part.points[t.corner[k]].data()); };
    area += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  return area;
}

TEST(MeshImport, RefusesWhatIsTooFarAway) {
  MeshReport report;
  const auto mesh = parseObjMesh("v 0 0 0\nv 1e200 0 0\nv 0 1e200 0\nf 1 2 3\n", "x.obj");
  try {
    meshPart(*mesh, {}, "x.obj", report);
    FAIL() << "it was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("a coordinate is 1e+200 m"), std::string::npos) << error.what();
  }
}

TEST(MeshImport, CutsConcavePolygonsWithinThem) {
  const struct {
    const char* what;
    std::string text;
    double area;
  } cases[] = {
      {"an L", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 3 4 5 6 1 2\n", 3},
      {"an arrow of four corners", "v 0 0 0\nv 2 -1 0\nv 1 0 0\nv 2 1 0\nf 2 3 4 1\n", 1},
      {"a frame with a slit to its hole",
       "v 0 0 1\nv 3 0 1\nv 3 3 1\nv 0 3 1\nv 1 1 1\nv 2 1 1\nv 2 2 1\nv 1 2 1\nf 1 2 3 4 1 5 8 7 6 5\n", 8},
      {"a corner on a side", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n", 4},
      {"twice round", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4 1 2 3 4\n", 1},
  };
  for (const auto& one : cases) {
    MeshReport report;
    EXPECT_NEAR(areaOf(partOf(one.text, report)), one.area, 1e-14) << one.what;
    EXPECT_EQ(report.non_manifold + report.degenerate + report.duplicates, 0u) << one.what;
  }
}

TEST(MeshImport, ReadsObjAsOtherProgramsWriteIt) {
  std::string mac = kCube, windows = kCube, first, goes_on = kCube;
  for (char& c : mac)
    if (c == '\n') c = '\r';
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) windows.insert(at, 1, '\r');
  first = std::string(kCube).substr(std::string(kCube).find("f ")) +
          std::string(kCube).substr(0, std::string(kCube).find("f "));
  goes_on.replace(goes_on.find("f 4 3 2 1"), 9, "f 4 3 \\\n2 1 # the bottom");
  for (const std::string& text : {mac, windows, first, goes_on, "\xef\xbb\xbf" + std::string(kCube)}) {
    const auto mesh = parseMesh(text, "x.obj");
    ASSERT_TRUE(mesh) << mesh.error();
    MeshReport report;
    meshPart(*mesh, {}, "x.obj", report);
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.volume, 1, 1e-15);
  }
}

TEST(MeshImport, ReadsStlAsOtherProgramsWriteIt) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  std::string large = "SOLID x\n" + facet + "ENDSOLID\n", one_line = " solid vertex facet\n" + facet + "endsolid\n";
  for (char& c : large) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (std::size_t at = one_line.find('\n') + 1; (at = one_line.find('\n', at)) != std::string::npos; ++at)
    if (one_line.compare(at + 1, 8, "endsolid") != 0) one_line[at] = ' ';
  for (const std::string& text : {large, one_line, " solid FLIRIS  \n" + facet + facet + "endsolid"}) {
    const auto mesh = parseStlMesh(text, "x.stl");
    ASSERT_TRUE(mesh) << mesh.error();
    EXPECT_EQ(mesh->points.size(), 3u);
    EXPECT_TRUE(mesh->remarks.empty());
  }
  EXPECT_EQ(parseStlMesh("solid\n" + facet, "x.stl")->remarks.size(), 1u);  // endsolid is missing
  std::string binary(84 + 50, '\0');
  binary.replace(0, 5, "solid");
  binary[80] = 1;
  EXPECT_TRUE(parseStlMesh(binary, "x.stl"));
  EXPECT_EQ(parseStlMesh(binary + "more", "x.stl")->remarks[0], "4 bytes after the last triangle were passed over");
  EXPECT_NE(errorOf(parseStlMesh(binary.substr(0, 130), "x.stl")).find("1 triangle has 134 bytes"), std::string::npos);
}

TEST(MeshImport, ReadsPlyAsOtherProgramsWriteIt) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property float quality\n";
  const std::string points = "0 0 0 nan\n1 0 0 1\n0 1 0 1\n0 0 1 1\n";
  const auto longer = parsePlyMesh(head + "element face 4\nproperty list uchar int vertex_indices\nend_header\n" +
                                       points + "3 0 2 1 9 9\n3 0 1 3 9 9\n3 1 2 3 9 9\n3 2 0 3 9 9\n",
                                   "x.ply");
  ASSERT_TRUE(longer) << longer.error();
  EXPECT_EQ(longer->remarks.size(), 1u);
  std::string one_line = points + "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3";
  for (char& c : one_line)
    if (c == '\n') c = ' ';
  const auto together = parsePlyMesh(
      head + "element face 4\nproperty list uchar int vertex_indices\nend_header\n" + one_line + "\n", "x.ply");
  ASSERT_TRUE(together) << together.error();
  EXPECT_EQ(together->remarks[0], "lines and elements do not agree; the values were read one after another");
  const auto strips = parsePlyMesh(head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                                       points + "10 0 2 1 3 0 -1 0 3 2 -1\n",
                                   "x.ply");
  ASSERT_TRUE(strips) << strips.error();
  for (const auto& mesh : {longer, together, strips}) {
    MeshReport report;
    meshPart(*mesh, {}, "x.ply", report);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.flipped, 0u);
    EXPECT_NEAR(report.volume, 1.0 / 6, 1e-15);
  }
}

/// A cube whose edge from point 1 to 2 has a point in its middle, which only a triangle without area uses.
TEST(MeshImport, StaysClosedWithoutTrianglesOfNoArea) {
  std::string text = std::string(kCube) + "v 0.5 0 0\n";
  text.replace(text.find("f 1 2 6 5"), 9, "f 1 9 2\nf 1 2 6\nf 1 6 5");
  text.replace(text.find("f 4 3 2 1"), 9, "f 9 1 4\nf 2 9 4\nf 3 2 4");
  MeshReport report;
  partOf(text, report);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.slivers, 1u);
  EXPECT_EQ(report.degenerate, 0u);
  EXPECT_NEAR(report.volume, 1, 1e-15);
}

TEST(MeshImport, JoinsPointsThatDifferByRounding) {
  std::string text = kCube;
  text.replace(text.find("f 1 2 6 5"), 9, "v 1.0000001 0.0000001 0\nf 1 9 6 5");
  MeshReport report;
  partOf(text, report);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.joined, 1u);
  text.replace(text.find("v 1.0000001 0.0000001"), 21, "v 1.0001000 0.0000000");
  MeshReport wide;
  partOf(text, wide);
  EXPECT_FALSE(wide.closed);
}

TEST(MeshImport, KeepsTheBorderOfATerrainFarFromTheOrigin) {
  std::string text;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      text += "v " + std::to_string(600000 + 0.2 * i) + " " + std::to_string(200000 + 0.2 * j) + " 0\n";
  for (int i = 0; i < 5; ++i)
    for (int j = 1; j < 6; ++j)
      text += "f " + std::to_string(6 * i + j) + " " + std::to_string(6 * i + j + 6) + " " +
              std::to_string(6 * i + j + 7) + " " + std::to_string(6 * i + j + 1) + "\n";
  MeshReport report;
  EXPECT_EQ(partOf(text, report).triangles.size(), 50u);
  EXPECT_EQ(report.joined, 0u);
}

TEST(MeshImport, JoinsNothingWhereEdgesAreTooShortToMeasure) {
  const std::string speck =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1e-300 0 0\nv 0 1e-300 0\nv 1e-300 1e-300 0\nv 2e-300 0 0\nv 0 3e-300 0\n"
      "f 1 2 3\nf 4 5 6\nf 4 7 8\nf 5 8 7\n";
  MeshReport report;
  partOf(speck, report);
  EXPECT_EQ(report.joined, 0u);
}

TEST(MeshImport, IgnoresFarPointsThatNoTriangleUses) {
  MeshReport report;
  EXPECT_EQ(partOf("v 1e9 0 0\n" + std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"), report).triangles.size(), 1u);
}

/// Returns a cube of a size at a place on the diagonal, facing inward if `inward`.
std::string cubeAt(double at, double size, int first, bool inward) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string(at + (i & 1) * size) + " " + std::to_string(at + (i >> 1 & 1) * size) + " " +
            std::to_string(at + (i >> 2) * size) + "\n";
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    text += "f";
    for (int k = 0; k < 4; ++k) text += " " + std::to_string(first + q[inward ? 3 - k : k]);
    text += "\n";
  }
  return text;
}

TEST(MeshImport, TurnsACavityWithTheShellAroundIt) {
  const struct {
    bool outer, inner;
    double volume;
    std::size_t flipped, bodies;
  } cases[] = {{false, true, 26, 0, 0}, {true, false, 26, 24, 0}, {false, false, 28, 0, 1}, {true, true, 28, 24, 1}};
  for (const auto& one : cases) {
    MeshReport report;
    partOf(cubeAt(0, 3, 1, one.outer) + cubeAt(1, 1, 9, one.inner), report);
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.volume, one.volume, 1e-12);
    EXPECT_EQ(report.flipped, one.flipped);
    EXPECT_EQ(report.solids_inside, one.bodies);
  }
}

/// A cube in the notch of an L is in its box, not in it.
TEST(MeshImport, TurnsAShellThatIsOnlyInTheBoxOfAnother) {
  std::string text =
      "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nv 0 0 4\nv 3 0 4\nv 3 1 4\nv 1 1 4\nv 1 3 4\n"
      "v 0 3 4\nf 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
  for (int k = 1; k <= 6; ++k)
    text += "f " + std::to_string(k) + " " + std::to_string(k % 6 + 1) + " " + std::to_string(k % 6 + 7) + " " +
            std::to_string(k + 6) + "\n";
  MeshReport report;
  partOf(text + cubeAt(1.5, 1, 13, true), report);
  EXPECT_TRUE(report.closed);
  EXPECT_NEAR(report.volume, 21, 1e-12);
  EXPECT_EQ(report.flipped, 12u);
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
