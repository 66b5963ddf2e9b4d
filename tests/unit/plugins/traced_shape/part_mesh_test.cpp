// SPDX-License-Identifier: MIT
#include "traced_shape/part_mesh.hpp"

#include <gtest/gtest.h>

#include <map>

#include "../kernels/brep/sample_solids.hpp"

namespace hapticd {
namespace {

using namespace brep::samples;

constexpr std::uint32_t kRed = 0x000000ffu, kGreen = 0x0000ff00u, kBlue = 0x00ff0000u, kOpaque = 0xff000000u;

/// A plate of 60 x 40 x 10 mm.
brep::Part plate() {
  return prism({{0, 0}, {60, 0}, {60, 40}, {0, 40}}, 10);
}

/// The area [m^2] that has each colour.
std::map<std::uint32_t, double> areas(const Mesh& mesh) {
  std::map<std::uint32_t, double> areas;
  const auto at = [&](std::size_t i) {
    return Eigen::Map<const Eigen::Vector3f>(mesh.xyz.data() + 3 * mesh.indices[i]);
  };
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    areas[mesh.colours[mesh.indices[i]]] +=
        0.5 * static_cast<double>((at(i + 1) - at(i)).cross(at(i + 2) - at(i)).norm());
  return areas;
}

TEST(PartMesh, HasNoColoursIfTheFileHasNone) {
  const Mesh mesh = tessellate(brep::Model(plate()), 1e-4);
  EXPECT_GE(mesh.indices.size(), 36u);
  EXPECT_TRUE(mesh.colours.empty());
}

TEST(PartMesh, AFaceHasItsOwnColourBeforeThatOfTheInstanceAndOfTheBody) {
  brep::Part part = plate();
  part.bodies[0].colour = kRed;
  EXPECT_NEAR(areas(tessellate(brep::Model(part), 1e-4))[kRed | kOpaque], 6.8e-3, 1e-8);
  part.instances.at(0).colour = kGreen | kOpaque;
  part.faces[0].colour = kBlue | 0x40000000u;  // glass is drawn as it is felt
  auto found = areas(tessellate(brep::Model(part), 1e-4));
  EXPECT_EQ(found.size(), 2u);
  EXPECT_GT(found[kBlue | kOpaque], 3e-4);
  EXPECT_NEAR(found[kBlue | kOpaque] + found[kGreen | kOpaque], 6.8e-3, 1e-8);
}

TEST(PartMesh, ACornerOfATriangleHasItsOwnColour) {
  brep::Part part;
  part.points = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {1, 0, 0}, {1.1, 0, 0}, {1, 0.1, 0}};
  part.triangles = {{{0, 1, 2}}, {{3, 4, 5}}};
  part.colours = {{{kRed | kOpaque, 0, kBlue | kOpaque}}, {}};
  part.bodies.resize(2);
  part.instances.resize(2);
  for (std::uint32_t b = 0; b < 2; ++b) {
    part.bodies[b].kind = brep::BodyKind::kMesh;
    part.bodies[b].first_point = 3 * b, part.bodies[b].point_count = 3;
    part.bodies[b].first_triangle = b, part.bodies[b].triangle_count = 1;
    part.instances[b].body = b;
  }
  part.instances[1].colour = kGreen;
  const Mesh mesh = tessellate(brep::Model(part), 1e-4);
  const std::uint32_t red = kRed | kOpaque, green = kGreen | kOpaque, blue = kBlue | kOpaque;
  EXPECT_EQ(mesh.colours, (std::vector<std::uint32_t>{red, 0, blue, green, green, green}));
}

TEST(PartMesh, WhatHasNoColourIsToldFromBlack) {
  brep::Part part = plate();
  part.faces[0].colour = kOpaque;
  const auto found = areas(tessellate(brep::Model(part), 1e-4));
  EXPECT_EQ(found.size(), 2u);
  EXPECT_TRUE(found.contains(0)) << "faces without a colour";
  EXPECT_TRUE(found.contains(kOpaque)) << "a black face";
}

}  // namespace
}  // namespace hapticd
