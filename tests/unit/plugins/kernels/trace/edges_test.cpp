// SPDX-License-Identifier: MIT
/// Force round sharp and open edges, in circles about points of them.
#include <gtest/gtest.h>

#include <numbers>

#include "kernels/trace/tracer.hpp"
#include "shapes.hpp"
#include "support/sweep.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 2000;      ///< of a circle
constexpr int kSearchTicks = 5;   ///< 5 ms at 1 kHz
constexpr double kRadius = 2e-4;  ///< [m] less than half of the thickness of any lip
const std::vector<double> kFractions =
    support::kLong ? std::vector{0.07, 0.37, 0.83} : std::vector{0.37};  ///< of an edge

/// A point of an edge, with the outward normals on both sides of it.
struct EdgePoint {
  Vector3d at, n, m;
  Vector3d aside;  ///< unit, at right angles to the edge and to n
};

EdgePoint joinedAt(const Model& model, int index, int side, double fraction) {
  const Patch& patch = model.patch(index);
  const Side& edge = patch.side(side);
  const Patch& next = model.patch(edge.patch);
  const auto uv = patch.onSide(side, fraction);
  spline::SurfacePoint E;
  patch.surface.evaluate1(uv[0], uv[1], E);
  const Vector3d n = patch.normalAt(uv);
  const Vector3d m = next.normalAt(next.onSide(edge.side, edge.flipped ? 1 - fraction : fraction));
  return {E.S, n, m, n.cross(m).normalized().cross(n)};
}

EdgePoint freeAt(const Model& model, int index, int side, double fraction) {
  const Patch& patch = model.patch(index);
  const auto uv = patch.onSide(side, fraction);
  spline::SurfacePoint E;
  patch.surface.evaluate1(uv[0], uv[1], E);
  const Vector3d n = patch.normalAt(uv), along = Patch::axisOf(side) == 0 ? E.Sv : E.Su;
  return {E.S, n, n, along.normalized().cross(n)};
}

void search(const Model& model, const Vector3d& p, Tracer& tracer) {
  Found found;
  model.search(p, 0.15, found);
  for (const auto* records : {&found.nearest, &found.rivals})
    for (const Near& near : *records) tracer.activate(near.surface, near.u, near.v, near.distance);
}

/// The greatest changes in a step of a circle, as shares of the step.
struct Change {
  double length = 0;  ///< of the length of the force, anywhere
  double force = 0;   ///< of the force, but where both sides of the edge are equally near
};

Change around(const Model& model, const EdgePoint& edge, double radius) {
  const double step_length = radius * 2 * std::numbers::pi / kSteps;
  const bool sharp = (edge.n - edge.m).norm() > 0;
  Tracer tracer(model);
  Change worst;
  Vector3d last = Vector3d::Zero();
  for (int tick = 0; tick <= kSteps; ++tick) {
    const double a = 2 * std::numbers::pi * tick / kSteps;
    const Vector3d aside = radius * (std::cos(a) * edge.n + std::sin(a) * edge.aside), p = edge.at + aside;
    if (tick % kSearchTicks == 0) search(model, p, tracer);
    const Foot foot = tracer.step(p);
    const Vector3d force = foot.depth > 0 ? Vector3d(foot.depth * foot.normal) : Vector3d::Zero();
    const bool between = sharp && std::abs(aside.dot((edge.n - edge.m).normalized())) < 0.02 * radius;
    if (tick > 0) {
      worst.length = std::max(worst.length, std::abs(force.norm() - last.norm()) / step_length);
      if (!between) worst.force = std::max(worst.force, (force - last).norm() / step_length);
    }
    last = force;
  }
  return worst;
}

/// Circles round all sharp edges. Returns how many.
int expectContinuous(const Model& model, const std::string& name) {
  int circles = 0;
  for (int index = 0; index < model.patchCount(); ++index)
    for (int side = 0; side < kSides; ++side) {
      if (model.patch(index).side(side).kind != SideKind::kJoined) continue;
      for (double fraction : kFractions) {
        const EdgePoint edge = joinedAt(model, index, side, fraction);
        if (edge.n.dot(edge.m) > 0.99) continue;
        ++circles;
        const Change worst = around(model, edge, kRadius);
        EXPECT_LE(worst.length, 1.01) << name << ' ' << index << ' ' << side << ' ' << fraction;
        EXPECT_LE(worst.force, 1.1) << name << ' ' << index << ' ' << side << ' ' << fraction;
      }
    }
  return circles;
}

/// A closed ring whose cross-section has four creases, all of random shape: bicubic, and around periodic.
spline::SurfaceData creasedRing(std::mt19937& random) {
  constexpr int kAround = 12, kCreases = 4, kAcross = 3 * kCreases, kWrap = 3;
  std::uniform_real_distribution<double> bump(-0.003, 0.003);
  double bumps[kAround][kAcross];
  for (auto& row : bumps)
    for (double& b : row) b = bump(random);
  spline::SurfaceData data;
  data.degree = {3, 3};
  for (int i = 0; i <= kAround + 2 * kWrap; ++i) data.knots[0].push_back(i);
  for (int crease = 0; crease <= kCreases; ++crease) data.knots[1].insert(data.knots[1].end(), 3, crease);
  data.knots[1].insert(data.knots[1].begin(), 0);
  data.knots[1].push_back(kCreases);
  for (int i = 0; i < kAround + kWrap; ++i)
    for (int j = 0; j <= kAcross; ++j) {
      const double a = 2 * std::numbers::pi * i / kAround, b = 2 * std::numbers::pi * j / kAcross;
      const double r = 0.02 + bumps[i % kAround][j % kAcross], out = 0.05 + r * std::cos(b);
      data.points.emplace_back(out * std::sin(a), r * std::sin(b), out * std::cos(a));
    }
  return data;
}

/// The depth is continuous everywhere, the direction everywhere but where both faces are equally near.
TEST(Edges, ForceRoundSharpEdgesIsContinuousButBetweenTheFaces) {
  int circles = 0;
  for (const char* name : {"box", "cylinder", "goblet"}) circles += expectContinuous(solid(name), name);
  EXPECT_GT(circles, static_cast<int>(kFractions.size()) * 12);
  EXPECT_EQ(expectContinuous(solid("teapot"), "teapot"), 0);  // all its common edges are smooth
}

TEST(Edges, ForceRoundCreasesOfRandomClosedModelsIsContinuousButBetweenTheFaces) {
  std::mt19937 random(21);
  int circles = 0;
  for (int i = 0; i < 3; ++i) {
    spline::SurfaceData data = creasedRing(random);
    for (bool reversed : {false, true}) {  // convex creases, then concave ones: the probe is in the ring
      data.reversed = reversed;
      const Model ring({data});
      ASSERT_TRUE(ring.closed(0));
      ASSERT_EQ(ring.patchCount(), 4);
      circles += expectContinuous(ring, reversed ? "hollow" : "ring");
    }
  }
  EXPECT_GE(circles, 2 * 3 * static_cast<int>(kFractions.size()) * 4);
}

/// The surface is a bevel of 45 degrees beyond an open edge, and parts act together: steeper, but no jump.
TEST(Edges, ForceRoundOpenEdgesOfTheTeapotIsContinuous) {
  const Model model = solid("teapot");
  int circles = 0;
  for (int index = 0; index < model.patchCount(); ++index)
    for (int side = 0; side < kSides; ++side) {
      if (model.patch(index).side(side).kind != SideKind::kFree) continue;
      for (double fraction : kFractions) {
        ++circles;
        const Change worst = around(model, freeAt(model, index, side, fraction), kRadius);
        EXPECT_LE(worst.length, 1.5) << index << ' ' << side << ' ' << fraction;
        EXPECT_LE(worst.force, 2) << index << ' ' << side << ' ' << fraction;
      }
    }
  EXPECT_EQ(circles, static_cast<int>(kFractions.size()) *
                         16);  // rim and lid, the mouth of the spout, and the buried ends of spout and handle
}

/// Straight over the rims that a probe can reach, on both sides of the sheet: the bevel adds the change aside to the
/// change in depth, so the force changes by the square root of two of the way, and by no more in a fast tick.
TEST(Edges, ForceOverOpenEdgesOfTheTeapotChangesByNoMoreThanTheBevelLets) {
  constexpr double kReach = 2.8e-4;  // [m] beyond, the other side of the spout's lip is as near
  const double steepest = std::numbers::sqrt2 + 1e-3;
  const Model model = solid("teapot");
  int rims = 0;
  for (int index = 0; index < model.patchCount(); ++index)
    for (int side = 0; side < kSides; ++side) {
      const bool buried = index >= 12 && index < 18;  // the handle, and where the spout begins
      if (buried || model.patch(index).side(side).kind != SideKind::kFree) continue;
      ++rims;
      for (double fraction : kFractions) {
        const EdgePoint edge = freeAt(model, index, side, fraction);
        for (double depth : {-kReach, -1e-4, -1e-5, 1e-5, 1e-4, kReach})
          for (double step : {4e-6, 3e-4}) {
            Tracer tracer(model);
            Vector3d last = Vector3d::Zero();
            const int ticks = static_cast<int>(2 * kReach / step);
            for (int tick = 0; tick <= ticks; ++tick) {
              const double x = (tick - 0.5 * ticks) * step;
              const Vector3d p = edge.at - depth * edge.n + x * edge.aside;
              if (tick % kSearchTicks == 0) search(model, p, tracer);
              const Foot foot = tracer.step(p);
              const Vector3d force = foot.depth > 0 ? Vector3d(foot.depth * foot.normal) : Vector3d::Zero();
              if (tick > 0) {
                ASSERT_LE((force - last).norm(), steepest * step)
                    << index << ' ' << side << ' ' << fraction << ", at a depth of " << depth << ", aside " << x;
              }
              last = force;
            }
          }
      }
    }
  EXPECT_EQ(rims, 4 + 2 + 4);  // body, mouth of the spout, lid
}

/// Farther in than half of a lip's thickness its two sides are equally near somewhere. Only there may the force jump.
TEST(Edges, ForceJumpsOnlyWhereTheNearestFootOfAPartDoes) {
  constexpr double kWide = 1e-3, kStep = kWide * 2 * std::numbers::pi / kSteps;
  std::vector<spline::SurfaceData> body = readModelFile(HAPTICD_SOURCE_DIR "/config/models/teapot.yaml").surfaces;
  const std::vector<spline::SurfaceData> tubes(body.begin() + 12, body.begin() + 20);  // handle and spout
  body.erase(body.begin() + 12, body.begin() + 20);
  const Model models[] = {solid("teapot"), Model(body), Model(tubes)};
  int jumps = 0;
  for (int index = 0; index < models[0].patchCount(); ++index)
    for (int side = 0; side < kSides; ++side) {
      if (models[0].patch(index).side(side).kind != SideKind::kFree) continue;
      const EdgePoint edge = freeAt(models[0], index, side, 0.37);
      Tracer tracers[] = {Tracer(models[0]), Tracer(models[1]), Tracer(models[2])};
      Vector3d last_force = Vector3d::Zero(), last_feet[3];
      for (int tick = 0; tick <= kSteps; ++tick) {
        const double a = 2 * std::numbers::pi * tick / kSteps;
        const Vector3d p = edge.at + kWide * (std::cos(a) * edge.n + std::sin(a) * edge.aside);
        Vector3d force = Vector3d::Zero();
        bool changed = false;
        for (int i = 0; i < 3; ++i) {
          if (tick % kSearchTicks == 0) search(models[i], p, tracers[i]);
          const Foot foot = tracers[i].step(p);
          if (i == 0 && foot.depth > 0) force = foot.depth * foot.normal;
          changed = changed || (i > 0 && (foot.point - last_feet[i]).norm() > 20 * kStep);
          last_feet[i] = foot.point;
        }
        const bool jump = tick > 0 && (force - last_force).norm() > 2.5 * kStep;
        jumps += jump ? 1 : 0;
        EXPECT_TRUE(!jump || changed) << index << ' ' << side << ' ' << tick;
        last_force = force;
      }
    }
  EXPECT_GT(jumps, 0);
  EXPECT_LT(jumps, 40);  // one or two an edge
}

}  // namespace
}  // namespace hapticd::trace
