// SPDX-License-Identifier: MIT
/// The slope of the stiffness, taken over a distance in metres: along the surface the force is that of one energy, and
/// along the normal what the file says is what is felt.
#include <gtest/gtest.h>

#include "bodies.hpp"
#include "kernels/medial/body.hpp"
#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/shear.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// A sheet whose stiffness rises from one corner to the other.
BodyData graded(const test::Sheet& sheet) {
  BodyData data;
  data.grid.count = {sheet.curve ? 1 : 7, 7};
  for (int i = 0; i < data.grid.count[0]; ++i) {
    for (int j = 0; j < 7; ++j) {
      data.grid.points.push_back(sheet.at(i / 6.0, j / 6.0));
      data.grid.radius.push_back(.01);
      data.stiffness.push_back(100 + 40 * i + 90 * j);
    }
  }
  return data;
}

BodyOptions at(double distance) {
  BodyOptions options;
  options.shear_distance = distance;
  return options;
}

TEST(ShearDistance, WhatTheFileSaysIsWhatAHandFeels) {
  for (const test::Sheet& sheet : test::sheets()) {
    const Body body(graded(sheet), at(.006));
    for (const double u : {0.0, .02, .35, .6, 1.0}) {
      spline::SurfacePoint s;
      body.skeleton().surface().evaluate1(u, .45, s);
      const Vector3d normal = sheet.curve ? s.Sv.unitOrthogonal() : s.Su.cross(s.Sv).normalized();
      SkeletonFoot foot = body.skeleton().nearest(s.S + .005 * normal, u, .45, {});
      const double stiffness = body.stiffness().evaluate(foot.u, foot.v).f;
      for (const double depth : {1e-6, 1e-3, 5e-3, 9e-3}) {
        const Vector3d p = foot.center + (.01 - depth) * foot.normal;
        const BodyForce answer = body.press(p, foot, foot.normal, depth, 0);
        EXPECT_NEAR(answer.normal, stiffness * depth, 1e-12) << sheet.name << " " << u << " " << depth;
        EXPECT_LE((answer.force - answer.normal * foot.normal).norm(), (1 + 1e-12) * answer.normal) << sheet.name;
        EXPECT_NEAR(answer.energy, .5 * stiffness * depth * depth, 1e-12);
      }
    }
    EXPECT_NEAR(body.greatestStiffness(), body.stiffness().greatest(), 0);
    EXPECT_TRUE(body.checkMonotonicity().holds());
  }
}

/// Force in the middle of a flat plate of this size [m] whose stiffness grows along x by 20 N/m a millimetre.
Vector3d onPlate(double size, const BodyOptions& options) {
  BodyData data;
  data.grid.count = {7, 7};
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) {
      data.grid.points.emplace_back(size * (i / 6.0 - .5), size * (j / 6.0 - .5), 0);
      data.grid.radius.push_back(.01);
      data.stiffness.push_back(3000 + 20e3 * data.grid.points.back().x());
    }
  }
  const Body body(data, options);
  const Vector3d p(.001, .002, .006);
  const SkeletonFoot foot = body.skeleton().search(p, {});
  return body.press(p, foot, foot.normal, foot.depth, 0).force;
}

TEST(ShearDistance, IsTheSameOnABodyOfAnySize) {
  const Vector3d small = onPlate(.06, at(.006)), large = onPlate(.18, at(.006));
  EXPECT_LT((small - large).norm(), 1e-9 * small.norm());
  BodyOptions share;
  share.shear_offset = .1;
  EXPECT_GT((onPlate(.06, share) - onPlate(.18, share)).norm(), .1 * small.norm());  // why it is in metres
}

/// A hand that goes toward the stiffer side must do what the spring stores more there: depth^2 / 2 times the slope.
TEST(ShearDistance, PushesTowardTheSofterSideByTheSlopeOfTheEnergy) {
  for (const double distance : {0., .006}) {
    BodyOptions options = at(distance);
    options.shear_offset = 0;
    const Vector3d force = onPlate(.12, options);
    EXPECT_NEAR(force.x(), -.5 * .004 * .004 * 20e3, 1e-9) << distance;
    EXPECT_NEAR(force.y(), 0, 1e-9);
  }
}

/// The slope of a deep press on a steep change would be a wall.
TEST(ShearDistance, PushesAsideNoHarderThanOutward) {
  const Vector3d wall = forceAlong({1e9, 0, 0}, Vector3d::UnitZ(), .5 * .01 * .01, 3);
  EXPECT_NEAR((wall - Vector3d(-3, 0, 0)).norm(), 0, 1e-12);
}

/// Where springs make a press stiffer, its slope is in proportion.
TEST(ShearDistance, CountsTheSpringsOfShearOffsetToo) {
  BodyOptions with, without;
  without.shear_offset = 0;
  const Vector3d springs = onPlate(.06, with), none = onPlate(.06, without);
  EXPECT_GT(springs.z(), 1.1 * none.z());
  EXPECT_LT(springs.x(), 1.1 * none.x());
}

/// A slab mesh on a plate of `size` m whose stiffness grows along x by 20 N/m a millimetre, of n x n vertices.
MeshBodyData meshPlate(double size, int n) {
  MeshBodyData data;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      data.mesh.vertices.push_back({{size * (i / (n - 1.0) - .5), size * (j / (n - 1.0) - .5), 0}, .01});
      data.stiffness.push_back(3000 + 20e3 * data.mesh.vertices.back().center.x());
      const int a = i * n + j;
      if (i + 1 == n || j + 1 == n) continue;
      data.mesh.triangles.push_back({a, a + n, a + n + 1});
      data.mesh.triangles.push_back({a, a + n + 1, a + 1});
    }
  }
  return data;
}

BodyForce onMesh(double size, int n, const Vector3d& p) {
  const MeshBody body(meshPlate(size, n), at(.006));
  const SkeletonFoot foot = body.foot(p, MedialMesh::kNoStart, 0);
  return body.press(p, foot, foot.normal, foot.depth, 0);
}

/// Whatever cones and slabs the neighbours are on.
TEST(ShearDistance, OnAMeshTurnsTheForceAsOnAGrid) {
  const Vector3d p(.001, .002, .006), grid = onPlate(.12, at(.006));
  for (const double size : {.06, .12, .18}) {
    for (const int n : {2, 5, 13}) {
      const BodyForce answer = onMesh(size, n, p);
      EXPECT_NEAR(answer.normal, 3020 * .004, 1e-9);
      EXPECT_NEAR(answer.force.z(), answer.normal, 1e-9);
      EXPECT_LT((answer.force - grid).norm(), 1e-9 * grid.norm()) << size << " " << n;
    }
  }
}

TEST(ShearDistance, OnAMeshDoesNotJumpFromSlabToSlab) {
  Vector3d before = onMesh(.12, 5, {-.02, -.013, .006}).force;
  for (int i = 1; i <= 400; ++i) {
    const Vector3d force = onMesh(.12, 5, {-.02 + 1e-4 * i, -.013 + 3e-5 * i, .006}).force;
    EXPECT_LT((force - before).norm(), 3500 * 1.05e-4);
    before = force;
  }
}

}  // namespace
}  // namespace hapticd::medial
