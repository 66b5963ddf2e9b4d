// SPDX-License-Identifier: MIT
/// Medial meshes whose dynamics are felt, and bodies that a probe is pushed through.
#include <random>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

const std::string kSlab =
    "4 0 2\nv -0.04 -0.03 0 0.01\nv 0.04 -0.03 0 0.01\nv 0.04 0.03 0 0.01\nv -0.04 0.03 0 0.01\nf 0 1 2\nf 0 2 3\n";

class FeltMesh : public Plugin {
 public:
  FeltMesh(const std::string& file, double dynamics, uint32_t probes = 1) : Plugin(file) {
    set("dynamics", dynamics);
    set("stiffness", 200.0);
    EXPECT_EQ(activate(probes), HSP_OK);
    for (uint32_t i = 0; i < probes; ++i) search({0, 0, .03}, i);
  }
};

TEST(FeltMesh, AHeldPressFeelsWhatABodyWithoutDynamicsDoes) {
  const TemporaryFile file("slab.ma", kSlab);
  for (const Vector3d& place : {Vector3d(.013, .011, 0), Vector3d(-.02, -.01, 0), Vector3d(.03, .0225, 0)}) {
    FeltMesh still(file.path(), 0), felt(file.path(), 3);
    const Vector3d outside = place + Vector3d(0, 0, .0102), inside = place + Vector3d(0, 0, .006);
    still.touch(outside);
    felt.touch(outside);
    const Vector3d wanted = forceOf(still.touch(inside));
    ASSERT_NEAR(wanted.z(), .8, .01) << place.transpose();
    for (int i = 0; i <= 200; ++i) felt.touch(outside + i / 200.0 * (inside - outside));
    for (int i = 0; i < 4000; ++i) felt.touch(inside);
    const Vector3d held = forceOf(felt.touch(inside));
    EXPECT_LT((held - Vector3d(0, 0, .8)).norm(), 1e-6) << place.transpose() << ": " << held.transpose();
    for (int i = 0; i < 1000; ++i) ASSERT_LT((forceOf(felt.touch(inside)) - held).norm(), 1e-9);
  }
}

TEST(FeltMesh, ASecondProbeMeetsTheSurfaceThatTheFirstHasPressed) {
  const TemporaryFile file("slab.ma", kSlab);
  FeltMesh body(file.path(), 3, 2);
  const Vector3d first(.01, .005, 0), second(.012, .005, 0);
  const auto at = [](const Vector3d& p, double z) { return Vector3d(p + Vector3d(0, 0, z)); };
  for (int i = 0; i <= 50; ++i) body.step({at(first, .0102 - 1e-4 * i), at(second, .0102)});
  for (int i = 0; i < 2000; ++i) body.step({at(first, .005), at(second, .0102)});
  for (int i = 0; i <= 20; ++i) body.step({at(first, .005), at(second, .0102 - 1e-4 * i)});
  EXPECT_EQ(body.step({at(first, .005), at(second, .0082)})[1].force[2], 0);  // in the dent of the first
}

TEST(FeltMesh, RandomMotionsMakeNoEnergy) {
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  const TemporaryFile file("slab.ma", kSlab);
  for (const double speed : {.02, .1, .5}) {
    FeltMesh body(file.path(), 3);
    Vector3d p(0, 0, .0101), velocity = Vector3d::Zero(), before = Vector3d::Zero();
    const Vector3d home = p;
    double worked = 0, turned_over = 0;
    body.touch(p);
    const int count = motions(10'000);
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < 3; ++k) velocity[k] += .1 * speed * normal(engine);
      velocity -= .02 * velocity + 20 * speed * (p - (home - Vector3d(0, 0, .003)));
      const Vector3d next = p + 1e-3 * velocity;
      const Vector3d force = forceOf(body.touch(next));
      worked -= .5 * (force + before).dot(next - p);
      turned_over = std::max(turned_over, std::fabs(worked));
      ASSERT_GT(worked, -1e-3 * turned_over - 1e-8) << speed << " " << i;
      p = next;
      before = force;
    }
    EXPECT_GT(turned_over, 1e-4);
  }
}

/// 25 mm in steps of 0.1 mm from above and out below: no tick changes the force by more than a steep spring would.
TEST(PushedThrough, LosesItsForceOverARadiusAndNotInATick) {
  const TemporaryFile file("slab.ma", kSlab);
  for (const std::string& body : {file.path(), std::string("soft-plate.yaml")}) {
    Plugin felt(body);
    felt.set("dynamics", 3.0);
    felt.set("shear_offset", 0.0);
    felt.set("stiffness", 200.0);
    ASSERT_EQ(felt.activate(), HSP_OK);
    felt.search({0, 0, .03});
    double most = 0, jump = 0, before = 0;
    for (int i = 0; i <= 500; ++i) {
      const double force = felt.touch({.003, .002, .0105 - 1e-4 * i}).force[2];
      jump = std::max(jump, std::fabs(force - before));
      most = std::max(most, force);
      before = force;
    }
    EXPECT_GT(most, 3) << body;
    EXPECT_LT(jump, .1 * most) << body;
    EXPECT_EQ(before, 0) << body;
  }
}

}  // namespace
}  // namespace hapticd::test
