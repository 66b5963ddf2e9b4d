// SPDX-License-Identifier: MIT
#include "kernels/medial/mesh_body.hpp"

#include <gtest/gtest.h>

#include "meshes.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr uint32_t kNoStart = MedialMesh::kNoStart;

Press pressOf(const SkeletonFoot& foot, double depth, double speed = 0) {
  return {foot.u, foot.v, foot.normal, depth, speed, foot.element};
}

MeshBodyData bodyOf(const MeshData& mesh, const Oscillator& material = {.01, .5, 300}) {
  return {mesh, {material.stiffness}, {material.damping}, {material.mass}};
}

double contourShift(const MeshBody& body, const SkeletonFoot& foot) {
  const Vector4d moved = body.deformation().at(foot.element, {foot.u, foot.v});
  return -moved.head<3>().dot(foot.normal) - moved[3];
}

TEST(MeshBody, AContactBringsTheContourToTheProbe) {
  for (const int rings : {0, 1, 2, 5}) {
    BodyOptions options;
    options.deformation.rings = rings;
    MeshBody body(bodyOf(test::sheet(9)), options);
    for (int k = 0; k < 50; ++k) {
      const SkeletonFoot foot = body.foot({.01 + .0017 * k, .09 - .0013 * k, .03}, kNoStart, 0);
      const Press contact = pressOf(foot, .003);
      body.deformation().reset();
      body.deformation().press({&contact, 1});
      ASSERT_NEAR(contourShift(body, foot), .003, 1e-12) << rings;
    }
  }
}

TEST(MeshBody, OnlyRingsRoundTheContactWake) {
  std::size_t before = 0;
  for (const int rings : {0, 1, 2, 3}) {
    BodyOptions options;
    options.deformation.rings = rings;
    MeshBody body(bodyOf(test::sheet(30)), options);
    const Press contact = pressOf(body.foot({.052, .047, .04}, kNoStart, 0), .002);
    body.deformation().press({&contact, 1});
    EXPECT_GT(body.deformation().awake(), before);
    EXPECT_LE(body.deformation().awake(), static_cast<std::size_t>(3 + 3 * (rings + 1) * (rings + 2) * 2));
    before = body.deformation().awake();
  }
}

TEST(MeshBody, TouchingOneBranchLeavesTheOthersAsleep) {
  MeshBody body(bodyOf(test::branches()), {});
  const Press contact = pressOf(body.foot({.03, .025, 0}, kNoStart, 0), .002);
  body.deformation().press({&contact, 1});
  for (std::size_t i = 9; i < body.deformation().count(); ++i)
    EXPECT_TRUE(body.deformation().displacement(i).isZero(0));
}

TEST(MeshBody, NothingJumpsWhileAPressSlidesOverElements) {
  BodyOptions options;
  options.deformation.dynamics = false;
  for (const MeshData& data : {test::sheet(9), test::branches()}) {
    MeshBody body(bodyOf(data), options);
    std::vector<Vector4d> before(data.vertices.size(), Vector4d::Zero());
    double jump = 0;
    for (int k = 0; k < 20000; ++k) {  // 3 um a step
      const Vector3d p = data.edges.empty() ? Vector3d(.02 + 3e-6 * k, .03 + 2e-6 * k, .035)
                                            : Vector3d(.003 + 1.6e-6 * k, .012 + .9e-6 * k, .001);
      const SkeletonFoot foot = body.foot(p, kNoStart, 0);
      const Press contact{foot.u, foot.v, Vector3d::UnitZ(), .004, 0, foot.element};
      body.deformation().press({&contact, 1});
      for (std::size_t i = 0; i < before.size(); ++i) {
        if (k > 0) jump = std::max(jump, (body.deformation().displacement(i) - before[i]).norm());
        before[i] = body.deformation().displacement(i);
      }
    }
    EXPECT_LT(jump, .004 * .01);
  }
}

TEST(MeshBody, EnergyOfAStruckBodyLeftAloneNeverGrows) {
  for (double k = 1; k <= 1e6; k *= 10) {
    for (double m = 1e-6; m <= 1e6; m *= 10) {
      for (const double zeta : {0.0, 0.01, 0.3, 1.0, 3.0, 10.0}) {
        const Oscillator material{m, 2 * zeta * std::sqrt(k * m), k};
        MeshBody body(bodyOf(test::branches(), material), {});
        const Press strike = pressOf(body.foot({.0, .012, .003}, kNoStart, 0), .003, 1.5);
        body.deformation().press({&strike, 1});
        double before = body.deformation().energy();
        ASSERT_GT(before, 0);
        for (int tick = 0; tick < 300; ++tick) {
          body.deformation().advance(1e-3);
          ASSERT_LE(body.deformation().energy(), before) << k << " " << m << " " << zeta << " " << tick;
          before = body.deformation().energy();
        }
      }
    }
  }
}

TEST(MeshBody, SeveralContactsHoldTheContourTogether) {
  MeshBody body(bodyOf(test::sheet(9)), {});
  const std::array<SkeletonFoot, 2> feet{body.foot({.04, .05, .04}, kNoStart, 0),
                                         body.foot({.055, .05, .04}, kNoStart, 0)};
  const std::array<Press, 2> contacts{pressOf(feet[0], .003), pressOf(feet[1], .002)};
  body.deformation().press(contacts);
  EXPECT_GE(contourShift(body, feet[0]), .003 - 1e-6);
  EXPECT_GE(contourShift(body, feet[1]), .002 - 1e-6);
}

TEST(MeshBody, ACreaseTurnsTheNormalWithoutAJump) {
  const MeshBody body(bodyOf(test::branches()), {});
  double jump = 0, sharp = 0;
  Vector3d before = Vector3d::Zero(), sharp_before = before;
  for (int k = -20000; k <= 20000; ++k) {  // 4 mm across the crotch, 2 mm deep, 0.1 um a step
    const Vector3d p(1e-7 * k, .0102, .0005);
    const SkeletonFoot foot = body.foot(p, kNoStart, 1e-3), edge = body.foot(p, kNoStart, 0);
    ASSERT_GT(foot.depth, 0);
    ASSERT_EQ(foot.depth, edge.depth);
    if (k > -20000) {
      jump = std::max(jump, (foot.normal - before).norm());
      sharp = std::max(sharp, (edge.normal - sharp_before).norm());
    }
    before = foot.normal;
    sharp_before = edge.normal;
  }
  EXPECT_GT(sharp, .1);
  EXPECT_LT(jump, .002);
}

/// A tube of 9 spheres, 5 mm apart, that turns by `bend` at each and whose spheres stand aside by rounding of an
/// import.
MeshData tube(double bend, double aside) {
  MeshData mesh;
  Vector3d at(-.02, 0, 0);
  for (int i = 0; i < 9; ++i) {
    mesh.vertices.push_back(
        {at + aside * Vector3d(0, std::sin(7.0 * i), std::cos(5.0 * i)), .012 + aside * std::sin(3.0 * i)});
    if (i > 0) mesh.edges.push_back({i - 1, i});
    at += .005 * Vector3d(std::cos(bend * (i - 3.5)), std::sin(bend * (i - 3.5)), 0);
  }
  return mesh;
}

TEST(MeshBody, AStraightTubeOfManyConesHasTheNormalsOfACylinder) {
  for (const double aside : {0.0, 1e-5}) {
    const MeshBody body(bodyOf(tube(0, aside)), {});
    double worst = 0;
    for (int k = 0; k <= 3400; ++k) {  // 5 mm deep, between the round ends, all about
      const double angle = .01 * k;
      const Vector3d across(0, std::cos(angle), std::sin(angle));
      const SkeletonFoot foot = body.foot(Vector3d(-.017 + 1e-5 * k, 0, 0) + .007 * across, kNoStart, 1e-3);
      worst = std::max(worst, std::acos(std::min(1.0, foot.normal.dot(across))));
    }
    EXPECT_LT(worst, aside > 0 ? .5 * M_PI / 180 : 1e-6)
        << aside;  // 1e-5 m aside and thinner over 5 mm lean by up to 0.4 degrees
  }
}

TEST(MeshBody, AFlatSheetOfManySlabsHasOneNormal) {
  MeshData flat = test::sheet(21);
  for (Sphere& vertex : flat.vertices) vertex.center.z() = 0, vertex.radius = .008;
  const MeshBody body(bodyOf(flat), {});
  for (int k = 0; k < 2000; ++k) {
    const SkeletonFoot foot = body.foot({.02 + 3e-5 * k, .03 + 2e-5 * k, .005}, kNoStart, 1e-3);
    ASSERT_GT(foot.normal.z(), 1 - 1e-12) << k;
  }
}

TEST(MeshBody, InTheBendOfATubeTheNormalTurnsWithoutAJump) {
  for (const double bend : {.05, .1, .2, .35}) {
    const MeshData data = tube(bend, 0);
    const MeshBody body(bodyOf(data), {});
    const Vector3d joint = data.vertices[4].center;
    double jump = 0, sharp = 0;
    Vector3d before = Vector3d::Zero(), sharp_before = before;
    for (int k = -20000; k <= 20000; ++k) {  // along the inner side, 0.1 um a step
      const Vector3d p = joint + Vector3d(1e-7 * k, .009, 0);
      ASSERT_LT(body.mesh().distance(p), 0);
      const SkeletonFoot foot = body.foot(p, kNoStart, 1e-3), edge = body.foot(p, kNoStart, 0);
      if (k > -20000) jump = std::max(jump, (foot.normal - before).norm());
      if (k > -20000) sharp = std::max(sharp, (edge.normal - sharp_before).norm());
      before = foot.normal, sharp_before = edge.normal;
    }
    EXPECT_GT(sharp, .5 * bend) << bend;
    EXPECT_LT(jump, .05 * sharp) << bend;
  }
}

TEST(MeshBody, NeverPullsAndPushesAsItsMaterialSays) {
  MeshBodyData data = bodyOf(test::branches());
  data.stiffness.assign(data.mesh.vertices.size(), 300);
  data.stiffness[0] = 600;
  const MeshBody body(data, {});
  const SkeletonFoot foot = body.foot({0, 0, .008}, kNoStart, 0);
  EXPECT_NEAR(foot.depth, .002, 1e-4);
  EXPECT_NEAR(body.press({0, 0, .008}, foot, foot.normal, foot.depth, 0).normal, 600 * foot.depth,
              600 * foot.depth * .1);
  EXPECT_EQ(body.press({0, 0, .008}, foot, foot.normal, foot.depth, -1e3).normal, 0);
  EXPECT_EQ(body.press({0, 0, .008}, foot, foot.normal, -1, 0).normal, 0);
  EXPECT_EQ(body.greatestStiffness(), 600);
}

TEST(MeshBody, RefusesMaterialOfAnotherLength) {
  MeshBodyData data = bodyOf(test::branches());
  data.mass = {1, 2, 3};
  EXPECT_THROW(MeshBody(data, {}), std::invalid_argument);
  data.mass = {-1};
  EXPECT_THROW(MeshBody(data, {}), std::invalid_argument);
}

}  // namespace
}  // namespace hapticd::medial
