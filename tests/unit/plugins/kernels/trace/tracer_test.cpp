// SPDX-License-Identifier: MIT
#include "kernels/trace/tracer.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "shapes.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

/// Activates what the global search finds, as the simulation side does every 5 ms.
void search(const Model& model, Tracer& tracer, const Vector3d& p) {
  std::vector<Near> near(static_cast<std::size_t>(model.surfaceCount()));
  const std::int64_t count = model.nearby(p, 0.15, near.data(), near.size());
  for (std::int64_t i = 0; i < count; ++i) {
    const Near& n = near[static_cast<std::size_t>(i)];
    tracer.activate(n.surface, n.u, n.v, n.distance);
  }
}

TEST(Tracer, WalksInAndAroundSolidsWithTheirSignedDistance) {
  for (const char* name : {"box", "cylinder", "torus", "sphere"}) {
    const Model model = solid(name);
    Tracer tracer(model);
    std::mt19937 random(3);
    std::normal_distribution<double> push(0, 0.02);
    Vector3d p(0.01, 0.02, 0.06), v(0, 0, 0);
    int bad = 0;
    for (int tick = 0; tick < 20000; ++tick) {
      v = 0.99 * v + Vector3d(push(random), push(random), push(random)) - 0.01 * p;
      p += 1e-3 * v;
      if (tick % 5 == 0) search(model, tracer, p);
      const Foot foot = tracer.step(p);
      ASSERT_GE(foot.surface, 0);
      ASSERT_LE(foot.evaluations, 12);
      EXPECT_NEAR(foot.normal.norm(), 1, 1e-12);
      bad += std::abs(foot.depth + signedDistance(name, p)) > 1e-9 ? 1 : 0;
    }
    EXPECT_LE(bad, 10) << name;  // across the medial axis, until the next search
  }
}

/// Along a closed path at constant depth under the skin of a solid, the force of a spring turns continuously.
TEST(Tracer, ForceIsContinuousAcrossSmoothSharedEdges) {
  const Model model = solid("cylinder");
  Tracer tracer(model);
  Vector3d last = Vector3d::Zero();
  constexpr int kTicks = 4000;
  for (int tick = 0; tick <= kTicks; ++tick) {
    const double angle = 4 * std::numbers::pi * tick / kTicks;
    const Vector3d p(0.039 * std::sin(angle), 0.01, 0.039 * std::cos(angle));
    if (tick == 0) search(model, tracer, p);
    const Foot foot = tracer.step(p);
    const Vector3d force = 800 * foot.depth * foot.normal;
    if (tick > 0) {
      EXPECT_LT((force - last).norm(), 0.01 * force.norm());
    }
    last = force;
  }
}

TEST(Tracer, TheTeapotsSharedEdgesAreNotFelt) {
  const Model model = solid("teapot");
  for (int index = 0; index < model.patchCount(); ++index) {
    const Patch& patch = model.patch(index);
    for (int side = 0; side < kSides; ++side) {
      const Side& edge = patch.side(side);
      if (edge.kind != SideKind::kJoined) continue;
      const auto uv = patch.onSide(side, 0.37);
      const Patch& next = model.patch(edge.patch);
      const Vector3d n = patch.normalAt(uv);
      const Vector3d other = next.normalAt(next.onSide(edge.side, edge.flipped ? 0.63 : 0.37));
      if (n.dot(other) < 0.9999) continue;  // the lid's rim is sharp
      spline::SurfacePoint E;
      patch.surface.evaluate1(uv[0], uv[1], E);
      const Vector3d across = (Patch::axisOf(side) == 0 ? E.Su : E.Sv).normalized();
      Tracer tracer(model);
      tracer.activate(patch.source, uv[0], uv[1], 0);
      Vector3d last = Vector3d::Zero();
      for (int tick = -50; tick <= 50; ++tick) {  // 0.2 mm deep, 1 um a tick
        const Foot foot = tracer.step(E.S - 2e-4 * n + 1e-6 * tick * across);
        const Vector3d force = 800 * foot.depth * foot.normal;
        if (tick > -50) {
          EXPECT_LT((force - last).norm(), 0.012 * force.norm()) << index << ' ' << side << ' ' << tick;
        }
        last = force;
      }
    }
  }
}

TEST(Tracer, KeepsTheTrackFarOutsideAndDeepInsideConvexFeatures) {
  constexpr double kR = 0.05;
  const Model model = solid("sphere");
  for (double offset : {-0.9, -0.5, -0.1, 0.5, 1.0, 1.5, 2.0}) {
    Tracer tracer(model);
    const double r = kR * (1 + offset);
    for (int tick = 0; tick < 2000; ++tick) {  // 2 m/s at 1 kHz, over both poles and the seam
      const double angle = 0.002 * tick / r;
      const Vector3d p = r * Vector3d(0.3 * std::sin(angle), std::cos(angle), std::sqrt(0.91) * std::sin(angle));
      if (tick == 0) search(model, tracer, p);
      const Foot foot = tracer.step(p);
      EXPECT_LT((foot.point - kR * p.normalized()).norm(), 3e-5) << offset << ' ' << tick;
    }
  }
}

TEST(Tracer, ContactOnASmoothPatchIsGoodToANanometreInOneEvaluation) {
  std::mt19937 random(11);
  const Model model({randomPatch(random, 6)});
  Tracer tracer(model);
  int evaluations = 0;
  constexpr int kTicks = 300;
  for (int tick = 0; tick < kTicks; ++tick) {  // 0.3 mm a tick, 2 mm deep
    const double t = 2 * std::numbers::pi * tick / kTicks;
    const Vector3d p(0.05 + 0.015 * std::cos(t), 0.05 + 0.015 * std::sin(t), -0.002);
    if (tick == 0) search(model, tracer, p);
    const Foot foot = tracer.step(p);
    if (tick > 0) evaluations += foot.evaluations;
    Near near;
    model.nearby(p, 1, &near, 1);
    spline::SurfacePoint E;
    model.patch(0).surface.evaluate1(near.u, near.v, E);
    EXPECT_LT((foot.point - E.S).norm(), 1e-9) << tick;
  }
  EXPECT_LE(evaluations, 2 * kTicks);
}

/// Four patches end in the middle of the bottom, and only one of them has been found so far.
TEST(Tracer, AFootOnAPoleGoesOnIntoAnyPatchAroundIt) {
  constexpr int kFirst = 28, kPatches = 4;  // of the teapot's bottom
  const Model model = solid("teapot");
  const Eigen::Array2d apex = model.patch(kFirst).onSide(0, 0.5);
  spline::SurfacePoint E;
  model.patch(kFirst).surface.evaluate1(apex[0], apex[1], E);
  ASSERT_EQ(model.patch(kFirst).sides[0].kind, SideKind::kPole);
  for (int start = kFirst; start < kFirst + kPatches; ++start)
    for (double angle = 0.1; angle < 6; angle += 0.5) {
      Tracer tracer(model);
      tracer.activate(start, apex[0], apex[1]);
      const Vector3d below = E.S - Vector3d(0, 1e-3, 0);
      EXPECT_LT((tracer.step(below).point - E.S).norm(), 1e-9);
      const Vector3d p = below + 5e-4 * Vector3d(std::cos(angle), 0, std::sin(angle));
      const Foot foot = tracer.step(p);
      Near near;
      model.nearby(p, 1, &near, 1);
      EXPECT_NEAR(foot.distance, near.distance, 1e-9) << start << ' ' << angle;
    }
}

/// Of surfaces that are far enough apart, ticks evaluate one; the foot is the nearest of all the same.
TEST(Tracer, SurfacesThatCannotBeTheNearestAreNotEvaluated) {
  constexpr int kSheets = 4, kTicks = 2000;
  std::mt19937 random(7);
  const spline::SurfaceData sheet = randomPatch(random);
  std::vector<spline::SurfaceData> sheets(kSheets, sheet);
  std::vector<Model> alone;
  for (int i = 0; i < kSheets; ++i) {
    for (auto& point : sheets[static_cast<std::size_t>(i)].points) point.z() += 0.01 * i;
    alone.push_back(Model({sheets[static_cast<std::size_t>(i)]}));
  }
  const Model model(sheets);
  Tracer tracer(model);
  int evaluations = 0;
  for (int tick = 0; tick < kTicks; ++tick) {  // up through the sheets and down again, going round at 0.3 mm a tick
    const double angle = 0.02 * tick;
    const Vector3d p(0.05 + 0.015 * std::cos(angle), 0.05 + 0.015 * std::sin(angle),
                     0.015 - 0.02 * std::cos(2 * std::numbers::pi * tick / kTicks));
    if (tick == 0) search(model, tracer, p);
    const Foot foot = tracer.step(p);
    evaluations += foot.evaluations;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Model& one : alone) {
      Near near;
      one.nearby(p, 1, &near, 1);
      nearest = std::min(nearest, near.distance);
    }
    EXPECT_NEAR(foot.distance, nearest, 1e-9) << tick;
  }
  EXPECT_LT(evaluations, kTicks * 3 / 2);
}

TEST(Tracer, BadSamplesLeaveNoTrace) {
  const Model model = solid("torus");
  Tracer with(model), without(model);
  const auto at = [](int tick) { return Vector3d(0.0001 * tick, 0.019, 0.05); };
  search(model, with, at(0));
  search(model, without, at(0));
  for (int tick = 0; tick < 100; ++tick) {
    if (tick == 50) {
      for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300})
        EXPECT_EQ(with.step(Vector3d(0, bad, 0)).status, FootStatus::kInvalid);
    }
    const Foot a = with.step(at(tick)), b = without.step(at(tick));
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.depth, b.depth);
  }
}

/// A neighbour that nobody asked for and that is far away was let go although the foot had gone on there: the next tick
/// wrote before the beginning of its tables.
TEST(Tracer, AFootIsOnASurfaceThatIsFollowedHoweverFarTheProbe) {
  spline::SurfaceData arch, beyond;
  arch.degree = {2, 1};
  arch.knots = {{{0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}}};
  arch.points = {{0, 0, 0}, {0, 0.1, 0}, {0.05, 0, 0.05}, {0.05, 0.1, 0.05}, {0.1, 0, 0}, {0.1, 0.1, 0}};
  beyond.degree = {1, 1};
  beyond.knots = {{{0, 0, 1, 1}, {0, 0, 1, 1}}};
  beyond.points = {{5.1, 0, 0}, {0.1, 0.1, 2}, {0.2, 0, 0}, {0.2, 0.1, 0}};
  ModelOptions options;
  options.edges = {EdgeLink{{0, 1}, {1, 0}, false}};  // the end of u to the beginning of u
  const Model model({arch, beyond}, options);
  for (const Vector3d& step : {Vector3d(1e9, 0, 0), Vector3d(1, 0, 1), Vector3d(0, 0, 0.5)}) {
    Tracer tracer(model);
    tracer.activate(0, 0.5, 0.5, 0.1);
    for (int tick = 0; tick < 20; ++tick) {
      const Foot foot = tracer.step(Vector3d(0.01, -0.02, 0.03) + tick * step);
      EXPECT_TRUE(tracer.active(foot.surface)) << "tick " << tick << ", step " << step.transpose();
    }
  }
}

TEST(Tracer, StopsWhenNothingIsActiveAndStartsAgain) {
  const Model model = solid("box");
  Tracer tracer(model);
  const Vector3d p(0.01, 0.049, 0.02);
  EXPECT_EQ(tracer.step(p).status, FootStatus::kIdle);
  search(model, tracer, p);
  EXPECT_NEAR(tracer.step(p).depth, 0.001, 1e-12);
  for (int surface = 0; surface < model.surfaceCount(); ++surface) tracer.deactivate(surface);
  EXPECT_EQ(tracer.activeCount(), 0);
  EXPECT_EQ(tracer.step(p).status, FootStatus::kIdle);
}

TEST(Tracer, DirectTracingLagsByTheKnownSteadyError) {
  // One first-order step multiplies the error by -d/R: 10 mm deep in a sphere of 50 mm the lag is a quarter of a tick.
  const Model model = solid("sphere");
  Tracer tracer(model);
  TraceOptions options;
  options.method = Method::kDirect;
  Foot foot;
  constexpr double kStep = 1e-4;
  Vector3d p;
  for (int tick = 0; tick < 300; ++tick) {
    const double angle = 0.3 + kStep * tick;
    p = 0.04 * Vector3d(std::sin(angle), 0, std::cos(angle));
    if (tick == 0) search(model, tracer, p);
    foot = tracer.step(p, options);
  }
  EXPECT_NEAR((foot.point - 0.05 * p.normalized()).norm() / (0.05 * kStep), 0.2 / 0.8, 0.03);
}

}  // namespace
}  // namespace hapticd::trace
