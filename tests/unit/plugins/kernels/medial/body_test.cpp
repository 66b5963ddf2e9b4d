// SPDX-License-Identifier: MIT
#include "kernels/medial/body.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

BodyData plate(double stiffness = 200) {
  BodyData data;
  data.grid.count = {7, 7};
  for (int i = 0; i < 49; ++i) data.grid.points.emplace_back(.1 * (i / 7) / 6, .08 * (i % 7) / 6, 0);
  data.grid.radius.assign(49, .01);
  data.stiffness.assign(49, stiffness);
  data.damping.assign(49, .5);
  data.mass.assign(49, .01);
  return data;
}

BodyForce pressed(const Body& body, const Vector3d& p, double speed = 0) {
  const SkeletonFoot foot = body.skeleton().search(p, {});
  return body.press(p, foot, foot.normal, foot.depth, speed);
}

TEST(Body, WithoutShearTheForceIsTheNormalSpring) {
  BodyOptions options;
  options.shear_offset = 0;
  const Body body(plate(), options);
  for (const double depth : {1e-6, 1e-3, 9e-3}) {
    const BodyForce answer = pressed(body, {.043, .037, .01 - depth});
    EXPECT_NEAR(answer.force.z(), 200 * depth, 1e-12);
    EXPECT_NEAR(answer.force.head<2>().norm(), 0, 1e-7 * depth);
    EXPECT_NEAR(answer.energy, 100 * depth * depth, 1e-12);
  }
}

TEST(Body, ForceGrowsWithDepthAndPointsOutward) {
  for (const test::Sheet& sheet : test::sheets()) {
    BodyData data = plate();
    data.grid.points.clear();
    data.grid.count = {sheet.curve ? 1 : 7, 7};
    const auto total = static_cast<std::size_t>(data.grid.count[0] * 7);
    for (int i = 0; i < data.grid.count[0]; ++i)
      for (int j = 0; j < 7; ++j) data.grid.points.push_back(sheet.at(i / 6.0, j / 6.0));
    for (auto* field : {&data.grid.radius, &data.stiffness, &data.damping, &data.mass}) field->resize(total);
    const Body body(data, {});
    ASSERT_TRUE(body.checkMonotonicity().holds()) << sheet.name;
    for (const double u : {.1, .35, .6, .93}) {
      spline::SurfacePoint s;
      body.skeleton().surface().evaluate1(u, .45, s);
      const Vector3d normal = sheet.curve ? s.Sv.unitOrthogonal() : s.Su.cross(s.Sv).normalized();
      SkeletonFoot foot = body.skeleton().nearest(s.S + .005 * normal, u, .45, {});
      double before = 0;
      for (int k = 1; k < 95; ++k) {
        const Vector3d p = s.S + (.01 - 1e-4 * k) * normal;
        const BodyForce answer = body.press(p, foot, normal, 1e-4 * k, 0);
        EXPECT_GT(answer.normal, before) << sheet.name << " " << u << " " << k;
        before = answer.normal;
      }
    }
  }
}

TEST(Body, SaysWhereShearSpringsMayPullInward) {
  BodyData data = plate(1);  // soft in the middle of a stiff, strongly bent sheet
  for (int i = 0; i < 49; ++i)
    data.grid.points[static_cast<std::size_t>(i)] = {.02 * std::cos(M_PI * (i / 7) / 6.0),
                                                     .02 * std::sin(M_PI * (i / 7) / 6.0), .08 * (i % 7) / 6};
  for (std::size_t i = 0; i < 49; ++i) data.stiffness[i] = i / 7 == 3 ? 1 : 1000;
  BodyOptions options;
  options.shear_offset = .4;
  EXPECT_FALSE(Body(data, options).checkMonotonicity().holds());
  options.shear_offset = 0;
  EXPECT_TRUE(Body(data, options).checkMonotonicity().holds());
}

TEST(Body, DampingOpposesTheClosingSpeedFromZeroAtTheSurface) {
  const Body body(plate(), {});
  const auto extra = [&](double depth, double speed) {
    const Vector3d p(.043, .037, .01 - depth);
    return pressed(body, p, speed).force.z() - pressed(body, p).force.z();
  };
  EXPECT_NEAR(extra(1e-9, .1), 0, 1e-7);
  EXPECT_NEAR(extra(6e-3, .1), .05, 1e-12);
  EXPECT_LT(extra(6e-3, -.1), 0);
  EXPECT_GE(pressed(body, {.043, .037, .0099}, -100).force.z(), 0);  // a surface does not pull
}

TEST(Body, ForceIsContinuousOverTheRim) {
  const Body body(plate(), {});
  Vector3d before = Vector3d::Zero();
  for (int k = 0; k <= 4000; ++k) {  // along x through the end of the plate and round its rim, 3 mm deep
    const double x = .08 + 1e-5 * k;
    const double z = x < .1 ? .007 : std::sqrt(std::max(0.0, .007 * .007 - (x - .1) * (x - .1)));
    if (x > .1 + .0069) break;
    const Vector3d force = pressed(body, {x, .04, z}).force;
    if (k > 0) {
      EXPECT_LT((force - before).norm(), .05) << x;
    }
    before = force;
  }
}

TEST(Body, RefusesNegativeMaterialAndSaysWhich) {
  BodyData data = plate();
  data.damping[5] = -1;
  try {
    Body body(data, {});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("damping"), std::string::npos);
  }
}

TEST(Body, AUniformBodyIsSmall) {
  EXPECT_LT(Body(plate(), {}).bytes(), 49u * 400);
}

}  // namespace
}  // namespace hapticd::medial
