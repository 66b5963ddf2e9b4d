// SPDX-License-Identifier: MIT
// A soft body that a scene makes harder or softer than its file says.
#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

TEST(StiffnessScale, TwiceTheStiffnessIsTwiceTheForce) {
  for (const char* model : {"soft-plate.yaml", "leaf.yaml", "branch.ma"}) {
    Plugin once(model), twice(model);
    twice.set("stiffness_scale", 2.0);
    ASSERT_EQ(once.activate(), HSP_OK);
    ASSERT_EQ(twice.activate(), HSP_OK);
    EXPECT_EQ(twice.report.max_stiffness, 2 * once.report.max_stiffness) << model;
    double box[2][3];
    once.extension<hsp_ext_geometry>(HSP_EXT_GEOMETRY).bounds(once.handle(), box[0], box[1]);
    const Vector3d p = 0.5 * (Vector3d(box[0]) + Vector3d(box[1]));
    int pressed = 0;
    for (double x = -0.02; x <= 0.02; x += 0.002) {
      const Vector3d at = p + Vector3d(x, 0.3 * x, 0);
      once.search(at), twice.search(at);
      const Vector3d soft = forceOf(once.touch(at)), hard = forceOf(twice.touch(at));
      EXPECT_LE((hard - 2 * soft).norm(), 1e-12 * soft.norm()) << model << " at " << at.transpose();
      pressed += soft.norm() > 0 ? 1 : 0;
    }
    EXPECT_GT(pressed, 5) << model;
  }
}

TEST(StiffnessScale, AStiffnessThatNoFileMayGiveIsRefused) {
  Plugin body;
  body.set("stiffness_scale", 1000.0);
  ASSERT_EQ(body.activate(), HSP_OK) << "200 N/m by 1000 is below 1e6 N/m";
  Plugin mesh("branch.ma");
  mesh.set("stiffness", 2000.0);
  mesh.set("stiffness_scale", 1000.0);
  EXPECT_NE(mesh.activate(), HSP_OK);
}

}  // namespace
}  // namespace hapticd::test
