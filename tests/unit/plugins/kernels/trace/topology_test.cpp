// SPDX-License-Identifier: MIT
/// Force across edges, overlapping parts, and rival feet.
#include <gtest/gtest.h>

#include <numbers>

#include "kernels/trace/tracer.hpp"
#include "shapes.hpp"
#include "support/sweep.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

int search(const Model& model, Tracer& tracer, const Vector3d& p) {
  Found found;
  model.search(p, 0.15, found);
  for (const auto* records : {&found.nearest, &found.rivals})
    for (const Near& near : *records) tracer.activate(near.surface, near.u, near.v, near.distance);
  return static_cast<int>(found.rivals.size());
}

Vector3d push(const Foot& foot) {
  return foot.depth > 0 ? Vector3d(foot.depth * foot.normal) : Vector3d::Zero();
}

/// A closed, smooth, bumpy ring: control points of a uniform bicubic spline, periodic in both directions.
spline::SurfaceData bumpyRing(std::mt19937& random) {
  constexpr int kAround = 12, kAcross = 8, kWrap = 3;
  std::uniform_real_distribution<double> bump(-0.003, 0.003);
  double bumps[kAround][kAcross];
  for (auto& row : bumps)
    for (double& b : row) b = bump(random);
  spline::SurfaceData data;
  data.degree = {3, 3};
  for (int i = 0; i <= kAround + 2 * kWrap; ++i) data.knots[0].push_back(i);
  for (int j = 0; j <= kAcross + 2 * kWrap; ++j) data.knots[1].push_back(j);
  for (int i = 0; i < kAround + kWrap; ++i)
    for (int j = 0; j < kAcross + kWrap; ++j) {
      const double a = 2 * std::numbers::pi * i / kAround, b = 2 * std::numbers::pi * j / kAcross;
      const double r = 0.02 + bumps[i % kAround][j % kAcross], out = 0.05 + r * std::cos(b);
      data.points.emplace_back(out * std::sin(a), r * std::sin(b), out * std::cos(a));
    }
  return data;
}

/// The greatest change of the spring's force in a step of 10 nm across any smooth edge, as a share of the force.
double worstStepAcrossEdges(const Model& model) {
  double worst = 0;
  for (int index = 0; index < model.patchCount(); ++index) {
    const Patch& patch = model.patch(index);
    for (int side = 0; side < kSides; ++side) {
      const Side& edge = patch.side(side);
      if (edge.kind != SideKind::kJoined) continue;
      for (double fraction : {0.07, 0.37, 0.71}) {
        const auto uv = patch.onSide(side, fraction);
        spline::SurfacePoint E, other;
        patch.surface.evaluate1(uv[0], uv[1], E);
        const Patch& next = model.patch(edge.patch);
        const auto there = next.onSide(edge.side, edge.flipped ? 1 - fraction : fraction);
        next.surface.evaluate1(there[0], there[1], other);
        const Vector3d n = patch.normalAt(uv);
        if (n.dot(next.normalAt(there)) < 0.9999 || (E.S - other.S).norm() > 1e-6) continue;  // sharp
        const Vector3d across = (Patch::axisOf(side) == 0 ? E.Su : E.Sv).normalized();
        Tracer tracer(model);
        Vector3d last = Vector3d::Zero();
        for (int tick = -100; tick <= 100; ++tick) {
          const Vector3d p = E.S - 2e-4 * n + 1e-8 * tick * across;
          if (tick == -100) search(model, tracer, p);
          const Vector3d force = push(tracer.step(p));
          if (tick > -100) worst = std::max(worst, (force - last).norm() / last.norm());
          last = force;
        }
      }
    }
  }
  return worst;
}

TEST(Topology, NoSmoothSharedEdgeOfAnyModelIsFelt) {
  for (const char* name : {"teapot", "box", "cylinder", "torus", "sphere", "goblet"})
    EXPECT_LT(worstStepAcrossEdges(solid(name)), 0.01) << name;
  std::mt19937 random(21);
  for (int i = 0; i < 3; ++i) {
    const Model ring({bumpyRing(random)});
    EXPECT_TRUE(ring.closed(0)) << "seams";
    EXPECT_LT(worstStepAcrossEdges(ring), 0.01) << "random closed model";
  }
}

/// Around a sharp edge the force may jump only where the edge itself decides: inside, where two faces are equally near.
TEST(Topology, ForceAtSharpEdgesIsContinuousOutsideTheirNormalCone) {
  const Model model = solid("box");
  std::mt19937 random(8);
  std::normal_distribution<double> turn(0, 1);
  for (int walk = 0; walk < 40; ++walk) {
    Tracer tracer(model);
    Vector3d p(0.05, 0.05, 0.01), last = Vector3d::Zero(), heading(turn(random), turn(random), turn(random));
    for (int tick = 0; tick < 500; ++tick) {
      heading =
          (heading + 0.2 * Vector3d(turn(random), turn(random), turn(random)) - 100 * (p - Vector3d(0.05, 0.05, 0.01)))
              .normalized();
      p += 2e-5 * heading;
      if (tick % 5 == 0) search(model, tracer, p);
      const Vector3d force = push(tracer.step(p));
      const bool between = std::abs(p.x() - p.y()) < 6e-5;  // the bisector of the two faces
      if (tick > 0 && !between) {
        EXPECT_LT((force - last).norm(), 2.1e-5) << p.transpose();
      }
      last = force;
    }
  }
}

std::vector<spline::SurfaceData> twoSpheres(double apart) {
  std::vector<spline::SurfaceData> two;
  for (double x : {-apart / 2, apart / 2}) {
    two.push_back(readModelFile(HAPTICD_SOURCE_DIR "/config/models/sphere.yaml").surfaces.front());
    for (auto& point : two.back().points) point.x() += x;
  }
  return two;
}

TEST(Topology, ShellsThatRunIntoEachOtherArePartsAndOthersAreNot) {
  EXPECT_EQ(Model(twoSpheres(0.06)).partCount(), 2);
  EXPECT_EQ(Model(twoSpheres(0.2)).partCount(), 1);
  EXPECT_EQ(solid("teapot").partCount(), 2);  // body and lid; spout and handle
  EXPECT_EQ(solid("goblet").partCount(), 1);
  std::vector<spline::SurfaceData> hollow(2, twoSpheres(0).front());  // a cavity is no second solid
  for (auto& point : hollow[1].points) point *= 0.5;
  hollow[1].reversed = true;
  EXPECT_EQ(Model(hollow).partCount(), 1);
}

TEST(Topology, PartsAreFoundAmongManyShells) {
  const spline::SurfaceData sphere = twoSpheres(0).front();
  std::vector<spline::SurfaceData> many;
  for (int i = 0; i < 400; ++i) {
    many.push_back(sphere);
    for (auto& point : many.back().points) point += 0.12 * Vector3d(i % 20, i / 20, 0);
  }
  const Model apart(many);
  EXPECT_EQ(apart.partCount(), 1);
  EXPECT_TRUE(apart.warnings().empty());
  many.push_back(many[217]);
  for (auto& point : many.back().points) point.z() += 0.06;
  const Model model(many);
  EXPECT_EQ(model.partCount(), 2);
  EXPECT_NE(model.part(model.patch(model.firstPatch(217)).shell), model.part(model.patch(model.firstPatch(400)).shell));
}

/// Two spheres that overlap: within the lens the probe must be led out of both, and no force kicks where they cross.
TEST(Topology, TheForceOfOverlappingSolidsIsContinuousAndLeadsOutOfBoth) {
  const Model model(twoSpheres(0.06));  // they meet in a circle of radius 0.04 about the origin
  const auto outside = [](const Vector3d& p) {
    return std::min((p - Vector3d(0.03, 0, 0)).norm(), (p + Vector3d(0.03, 0, 0)).norm()) - 0.05;
  };
  Tracer tracer(model);
  Vector3d last = Vector3d::Zero();
  for (int tick = 0; tick <= 4000; ++tick) {  // from one sphere into the other, 1 mm under the crease
    const Vector3d p(-0.01 + 5e-6 * tick, 0.039 * std::cos(0.3), 0.039 * std::sin(0.3));
    if (tick % 5 == 0) search(model, tracer, p);
    const Foot foot = tracer.step(p);
    ASSERT_GT(foot.depth, 0) << tick;
    ASSERT_LE(foot.evaluations, 12);
    EXPECT_GT(outside(p + push(foot)), -2e-5) << tick;  // the planes stand for the spheres
    if (tick > 0) {
      EXPECT_LT((push(foot) - last).norm(), 2e-5) << tick;
    }
    last = push(foot);
  }
}

Foot footOn(const Model& model, const Vector3d& p) {
  Tracer tracer(model);
  search(model, tracer, p);
  Foot foot;
  for (int tick = 0; tick < 3; ++tick) foot = tracer.step(p);
  EXPECT_LE(foot.evaluations, 12);
  return foot;
}

TEST(Topology, ABuriedEndIsNotFeltAndTheBodyPushesOut) {
  const Model model = solid("teapot");
  std::vector<spline::SurfaceData> body = readModelFile(HAPTICD_SOURCE_DIR "/config/models/teapot.yaml").surfaces;
  const std::vector<spline::SurfaceData> tubes(body.begin() + 12, body.begin() + 20);  // handle and spout
  body.erase(body.begin() + 12, body.begin() + 20);
  const Model body_alone(body), tubes_alone(tubes);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  int buried = 0;
  for (int i = 0; i < 4000; ++i) {  // around the tubes
    const Patch& patch = tubes_alone.patch(i % tubes_alone.patchCount());
    const Eigen::Array2d uv = patch.lo + (patch.hi - patch.lo) * Eigen::Array2d(share(random), share(random));
    spline::SurfacePoint E;
    patch.surface.evaluate1(uv[0], uv[1], E);
    const Vector3d p = E.S + 1e-3 * share(random) * patch.normalAt(uv);
    const Foot in_body = footOn(body_alone, p), in_tube = footOn(tubes_alone, p);
    if (in_body.depth < 2e-4 || in_tube.depth > 0 || in_tube.distance > in_body.distance) continue;
    const Foot foot = footOn(model, p);  // the nearest surface is a buried one, seen from outside
    EXPECT_GE(foot.depth, in_body.depth - 1e-9) << p.transpose();
    EXPECT_GT(foot.normal.dot(in_body.normal), 0) << p.transpose();
    ++buried;
  }
  EXPECT_GT(buried, 20);
}

TEST(Topology, FeetInTwoValleysOfOnePatchAreFollowed) {
  const Model model = solid("goblet");
  Tracer tracer(model);
  std::mt19937 random(7);
  std::normal_distribution<double> turn(0, 1);
  Vector3d p(0.01, 0.0, 0.01), heading(1, 0, 0);
  int wrong = 0, wrong_near = 0, longest = 0, run = 0, rivals = 0;
  const int ticks = support::kLong ? 40000 : 10000;
  for (int tick = 0; tick < ticks; ++tick) {  // 1 m/s
    const Vector3d home(-20 * p.x(), -20 * p.y() * std::abs(p.y()) / 0.06, -20 * p.z());
    heading = (heading + 0.15 * Vector3d(turn(random), turn(random), turn(random)) + 0.1 * home).normalized();
    p += 1e-3 * heading;
    if (tick % 5 == 0) rivals += search(model, tracer, p);
    const Foot foot = tracer.step(p);
    ASSERT_LE(foot.evaluations, 12);
    Near near;
    model.nearby(p, 1, &near, 1);
    const bool bad = foot.distance > near.distance + 1e-4;
    run = bad ? run + 1 : 0;
    longest = std::max(longest, run);
    wrong += bad ? 1 : 0;
    wrong_near += bad && near.distance < 0.005 ? 1 : 0;
  }
  EXPECT_GT(rivals, ticks / 40);
  EXPECT_LE(wrong, ticks / 500);  // valleys that did not exist at the last search; 400 without rivals
  EXPECT_LE(wrong_near, 2);
  EXPECT_LE(longest, 5);
}

}  // namespace
}  // namespace hapticd::trace
