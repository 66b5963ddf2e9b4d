// SPDX-License-Identifier: MIT
// A soft body that is touched by a ball.
#include <random>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

constexpr double kRadius = 4e-3;

const std::string kTube = "2 1 0\nv -0.05 0 0 0.01\nv 0.05 0 0 0.01\ne 0 1\n";

double highest(Plugin& body) {
  hsp_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  EXPECT_EQ(body.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY).tessellate(body.handle(), 1e-5, &mesh), HSP_OK);
  double z = -1;
  for (uint32_t i = 0; i < mesh.vertex_count; ++i) z = std::max<double>(z, mesh.xyz[3 * i + 2]);
  return z;
}

TEST(TipRadius, ATubeIsTouchedByTheBallAndDrawnAsItIs) {
  const TemporaryFile file("tube.ma", kTube);
  Plugin tube(file.path());
  tube.set("stiffness", 200.0);
  tube.set("tip_radius", kRadius);
  ASSERT_EQ(tube.activate(), HSP_OK);
  tube.search({.01, 0, .03});
  EXPECT_NEAR(highest(tube), .01, 1e-5);
  EXPECT_EQ(forceOf(tube.touch({.01, 0, .0141})).norm(), 0);
  const hsp_contact contact = tube.touch({.01, 0, .012});
  EXPECT_NEAR(contact.depth_m, .002, 1e-12);
  EXPECT_NEAR(contact.force[2], .4, 1e-9);
  EXPECT_NEAR(contact.point[2], .014, 1e-12);
}

TEST(TipRadius, OutsideTheGapOfTheBallIsThatOfThePointLessTheRadius) {
  for (const char* model : {"soft-plate.yaml", "leaf.yaml", "loaf.yaml", "branch.ma"}) {
    Plugin point(model), ball(model);
    ball.set("tip_radius", kRadius);
    ASSERT_EQ(point.activate(), HSP_OK);
    ASSERT_EQ(ball.activate(), HSP_OK);
    double box[2][3];
    point.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY).bounds(point.handle(), box[0], box[1]);
    std::mt19937_64 random(4);
    int outside = 0;
    for (int i = 0; i < 3000; ++i) {
      Vector3d p;
      for (int k = 0; k < 3; ++k) p[k] = std::uniform_real_distribution(box[0][k] - .02, box[1][k] + .02)(random);
      const auto depthOf = [&p](Plugin& body) {
        body.search(p);
        return body.step({p}, Vector3d::Zero(), 1e-3, HSP_IN_JUMP)[0].depth_m;
      };
      const double of_point = depthOf(point), of_ball = depthOf(ball);
      // both are outside and at rest, and near enough for the search of the whole body
      if (of_point > -kRadius - 1e-4 || of_point < -9e-3) continue;
      EXPECT_NEAR(of_ball, of_point + kRadius, 1e-8) << model << " at " << p.transpose();
      ++outside;
    }
    EXPECT_GT(outside, 100) << model;
  }
}

/// Warnings of a mesh in a model file when it is activated.
std::string warned(const char* material, std::initializer_list<std::pair<const char*, double>> parameters) {
  const TemporaryFile file("tissue.yaml",
                           "format: hapticd-model/2\nmedial:\n  vertices: [[-0.05, 0, 0, 0.01], [0.05, 0, 0, 0.01]]\n"
                           "  edges: [[0, 1]]\n  " +
                               std::string(material) + "\n");
  Plugin body(file.path());
  for (const auto& [id, value] : parameters) EXPECT_EQ(body.set(id, value), HSP_OK);
  testing::internal::CaptureStdout();
  EXPECT_EQ(body.activate(), HSP_OK);
  return testing::internal::GetCapturedStdout();
}

TEST(TipRadius, WarnsIfTheStiffnessIsThatOfATipOfAnotherRadius) {
  const std::string tissue = "young: 10e3\n  poisson: 0.45\n  thickness: 0.02";
  EXPECT_NE(warned(tissue.c_str(), {{"tip_radius", 3e-3}}).find("write also probe_radius: 0.003"), std::string::npos);
  EXPECT_EQ(warned(tissue.c_str(), {{"tip_radius", 3e-3}, {"probe_radius", 3e-3}}), "");
  EXPECT_EQ(warned(tissue.c_str(), {}), "") << "a point has no radius of its own";
  EXPECT_EQ(warned("stiffness: 300", {{"tip_radius", 3e-3}}), "");
}

TEST(MatDeformable, AMeshOfAModelFileHasRings) {
  EXPECT_EQ(warned("stiffness: 300", {{"rings", 5}}), "");
}

}  // namespace
}  // namespace hapticd::test
