// SPDX-License-Identifier: MIT
/// A hand on whole models: walks near and through them against the exact global search, stand-off, deep corners.
#include <gtest/gtest.h>

#include "kernels/trace/tracer.hpp"
#include "shapes.hpp"
#include "support/sweep.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Vector3d;

constexpr int kSearchTicks = 5;  // 5 ms at 1 kHz

void offer(const Found& found, Tracer& tracer) {
  for (const auto* records : {&found.nearest, &found.rivals})
    for (const Near& near : *records) tracer.activate(near.surface, near.u, near.v, near.distance);
}

Vector3d pointOn(const Model& model, const Near& near) {
  spline::SurfacePoint E;
  for (int i = model.firstPatch(near.surface); i < model.lastPatch(near.surface); ++i) {
    const Patch& patch = model.patch(i);
    const Eigen::Array2d uv(near.u, near.v);
    if ((uv >= patch.lo).all() && (uv <= patch.hi).all()) patch.surface.evaluate1(near.u, near.v, E);
  }
  return E.S;
}

/// Wanders at `speed` between 2 mm outside and `deepest` inside, where a foot found anew says that the probe is.
class Wanderer {
 public:
  Wanderer(const Model& model, double speed, double deepest) : speed_(speed), deepest_(deepest) {
    const Patch& patch = model.patch(model.patchCount() / 2);
    const Eigen::Array2d middle = 0.5 * (patch.lo + patch.hi);
    spline::SurfacePoint E;
    patch.surface.evaluate1(middle[0], middle[1], E);
    at_ = E.S;
  }

  const Vector3d& at() const { return at_; }
  void go(const Foot& foot, int tick) {
    constexpr double kOutside = 0.002;
    constexpr int kChange = 200;
    if (tick % kChange == 0) goal_ = std::uniform_real_distribution<double>(-kOutside, deepest_)(random_);
    const auto turn = [this] { return 0.15 * std::normal_distribution<double>()(random_); };
    heading_ +=
        Vector3d(turn(), turn(), turn()) + 0.5 * std::clamp((foot.depth - goal_) / 0.002, -1.0, 1.0) * foot.normal;
    heading_.normalize();
    at_ += 1e-3 * speed_ * heading_;
  }

 private:
  std::mt19937 random_{5};
  Vector3d at_, heading_{1, 0, 0};
  double speed_, deepest_, goal_ = 0;
};

struct WalkResult {
  int longest = 0, most_evaluations = 0;
  double most_push = 0;  // [m] by which the force's depth exceeds that of feet found anew
};

/// The tracer with a search every 5 ms beside one that is started anew, with all the evaluations it wants, in each
/// tick.
WalkResult walk(const Model& model, double speed, double deepest, const TraceOptions& options, int ticks) {
  constexpr double kBad = 1e-4;
  WalkResult result;
  Wanderer hand(model, speed, deepest);
  Tracer tracer(model), anew(model);
  TraceOptions thorough;
  thorough.unite = options.unite;
  thorough.max_evaluations = 100'000;
  Found found;
  int run = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    model.search(hand.at(), 0.15, found);
    anew.reset();
    offer(found, anew);
    Foot truth;
    for (int i = 0; i < 3; ++i) truth = anew.step(hand.at(), thorough);
    if (tick % kSearchTicks == 0) offer(found, tracer);
    const Foot foot = tracer.step(hand.at(), options);
    result.most_evaluations = std::max(result.most_evaluations, foot.evaluations);
    const bool bad = options.unite ? std::abs(std::max(foot.depth, 0.0) - std::max(truth.depth, 0.0)) > kBad
                                   : foot.distance > found.nearest.front().distance + kBad;
    run = bad ? run + 1 : 0;
    result.longest = std::max(result.longest, run);
    result.most_push = std::max(result.most_push, foot.depth - std::max(truth.depth, 0.0));
    hand.go(truth, tick);
  }
  return result;
}

TEST(Walks, EveryModelIsFoundAgainWithinFiveMillisecondsInTwelveEvaluations) {
  for (const char* name : {"teapot", "goblet", "box", "cylinder", "torus", "sphere"}) {
    const Model model = solid(name);
    for (double speed : {1.0, 2.0})
      for (bool unite : {false, true}) {
        TraceOptions options;
        options.unite = unite;
        const WalkResult result = walk(model, speed, 0.005, options, support::kLong ? 4000 : 1000);
        EXPECT_LE(result.longest, kSearchTicks) << name << ' ' << speed << ' ' << unite;
        EXPECT_LE(result.most_evaluations, 12) << name;
      }
  }
}

/// The nearest foot found anew, with all the evaluations it wants.
Foot footAnew(const Model& model, Tracer& tracer, const Vector3d& p) {
  TraceOptions thorough;
  thorough.unite = false;
  thorough.max_evaluations = 100'000;
  Found found;
  model.search(p, 0.15, found);
  tracer.reset();
  offer(found, tracer);
  return tracer.step(p, thorough);
}

/// Whether the nearest foot jumps between two places of the probe: then two feet are equally near on the way. [m]
bool footJumps(const Model& model, const Vector3d& from, const Vector3d& to) {
  constexpr int kPieces = 64;
  constexpr double kSame = 1e-9, kApart = 1e-4;
  Tracer tracer(model);
  Vector3d a = from;
  Foot at_a = footAnew(model, tracer, a);
  for (int i = 1; i <= kPieces; ++i) {
    const Vector3d end = from + (to - from) * i / kPieces;
    const Foot at_end = footAnew(model, tracer, end);
    Vector3d b = end;
    Foot at_b = at_end;
    while ((b - a).norm() > 1e-12) {
      const Vector3d middle = 0.5 * (a + b);
      if (middle == a || middle == b) break;
      const Foot foot = footAnew(model, tracer, middle);
      const bool jumps_first = (foot.point - at_a.point).norm() > (foot.point - at_b.point).norm();
      (jumps_first ? b : a) = middle;
      (jumps_first ? at_b : at_a) = foot;
      if ((at_a.point - at_b.point).norm() <= kApart) break;
    }
    if ((at_a.point - at_b.point).norm() > kApart && std::abs(at_a.distance - at_b.distance) < kSame) return true;
    a = end;
    at_a = at_end;
  }
  return false;
}

/// Twelve evaluations are enough at 2 m/s: only where the nearest foot truly jumps, it takes a search to find it.
TEST(Walks, AFootIsMissedOnlyWhereTheNearestOneJumps) {
  const Model model = solid("teapot");
  TraceOptions options;
  options.unite = false;
  Wanderer hand(model, 2, 0.005);
  Tracer tracer(model), anew(model);
  Found found;
  Vector3d last_good = hand.at(), last = hand.at();
  int missed = 0;
  bool bad = false;
  const int ticks = support::kLong ? 4000 : 1500;
  for (int tick = 0; tick < ticks; ++tick) {
    model.search(hand.at(), 0.15, found);
    if (tick % kSearchTicks == 0) offer(found, tracer);
    const Foot foot = tracer.step(hand.at(), options);
    const double excess = foot.distance - found.nearest.front().distance;
    if (excess < 1e-8) last_good = hand.at();
    if (excess > 1e-4 && !bad) {
      ++missed;
      EXPECT_TRUE(footJumps(model, last_good, last) || footJumps(model, last, hand.at()))
          << tick << ": " << excess << " after " << foot.evaluations;
    }
    bad = excess > 1e-4;
    last = hand.at();
    hand.go(footAnew(model, anew, hand.at()), tick);
  }
  EXPECT_LT(missed, 80);
}

/// A part of which the nearest foot is not certain yet may seem to hold the probe deep inside.
TEST(Walks, PartsThatRunIntoEachOtherNeverKick) {
  const Model model = solid("teapot");
  for (double speed : {0.5, 1.0}) {
    const WalkResult result = walk(model, speed, 0.003, {}, support::kLong ? 12000 : 4000);
    EXPECT_LT(result.most_push, 0.008) << speed;  // where feet change sides; was 0.08
  }
}

TEST(Walks, DirectTracingKeepsToItsEvaluations) {
  const Model model = solid("teapot");
  TraceOptions options;
  options.method = Method::kDirect;
  for (int steps : {1, 4}) {
    options.iterations = steps;
    const WalkResult result = walk(model, 1, 0.003, options, support::kLong ? 4000 : 1500);
    EXPECT_LE(result.most_evaluations, 12) << steps;
    EXPECT_LE(result.longest, 2 * kSearchTicks) << steps;
  }
}

TEST(Walks, SolidsThatOverlapByLittlePushByLittle) {
  std::vector<spline::SurfaceData> two;
  for (double x : {-0.049, 0.049}) {
    two.push_back(readModelFile(HAPTICD_SOURCE_DIR "/config/models/sphere.yaml").surfaces.front());
    for (auto& point : two.back().points) point.x() += x;
  }
  const Model model(two);
  ASSERT_EQ(model.partCount(), 2);
  Tracer tracer(model);
  Found found;
  for (int tick = 0; tick < 400; ++tick) {  // through the lens, 2 mm thick, between walls that face each other
    const Vector3d p(-0.002 + 1e-5 * tick, 0.001, 0);
    model.search(p, 0.15, found);
    offer(found, tracer);
    const Foot foot = tracer.step(p);
    const double deeper =
        std::max(0.05 - (p - Vector3d(0.049, 0, 0)).norm(), 0.05 - (p + Vector3d(0.049, 0, 0)).norm());
    EXPECT_LE(foot.depth, 2 * deeper + 1e-9) << tick;
    EXPECT_GE(foot.depth, 0.5 * deeper) << tick;
  }
}

struct StandOff {
  int longest = 0;  ///< ticks in a row of feet farther than 0.1 mm
  double worst =
      0;  ///< [m] error of the foot while the true one moves steadily, and has for longer than a search takes
  int judged = 0;
};

/// Back and forth over a patch at an offset from it, at `speed` and 1 kHz.
StandOff standOff(const Model& model, int patch_index, double offset, double speed) {
  Tracer tracer(model);
  const Patch& patch = model.patch(patch_index);
  Found found;
  spline::SurfacePoint E;
  StandOff result;
  Eigen::Array2d uv = patch.lo + 0.2 * (patch.hi - patch.lo), heading = (patch.hi - patch.lo) * Eigen::Array2d(1, 0.37);
  Vector3d p, foot_was, step_was = Vector3d::Zero();
  int run = 0, calm = 0;
  for (int tick = 0; tick < 500; ++tick) {
    patch.surface.evaluate1(uv[0], uv[1], E);
    p = E.S + offset * patch.normalAt(uv);
    model.search(p, 1, found);
    const Vector3d truth = pointOn(model, found.nearest.front());
    if (tick == 0) foot_was = truth;
    if (tick % kSearchTicks == 0) offer(found, tracer);
    const Foot foot = tracer.step(p);
    const bool bad = foot.distance > found.nearest.front().distance + 1e-4;
    run = bad ? run + 1 : 0;
    result.longest = std::max(result.longest, run);
    const Vector3d step = truth - foot_was;
    calm = (step - step_was).norm() <= 0.5 * step.norm() + 1e-5 ? calm + 1 : 0;
    foot_was = truth;
    step_was = step;
    if (calm > kSearchTicks) result.worst = std::max(result.worst, (foot.point - truth).norm());
    result.judged += calm > kSearchTicks ? 1 : 0;
    // The next place: as far from this one in space as the probe goes in a tick, found by halving.
    Eigen::Array2d d = heading;
    for (int axis = 0; axis < 2; ++axis)
      if (uv[axis] + 0.01 * d[axis] < patch.lo[axis] || uv[axis] + 0.01 * d[axis] > patch.hi[axis])
        heading[axis] = -heading[axis], d[axis] = -d[axis];
    for (int i = 0; i < 40; ++i, d *= 0.7) {
      const Eigen::Array2d there = (uv + d).max(patch.lo).min(patch.hi);
      patch.surface.evaluate1(there[0], there[1], E);
      if ((E.S + offset * patch.normalAt(there) - p).norm() <= 1e-3 * speed) break;
    }
    uv = (uv + d).max(patch.lo).min(patch.hi);
  }
  return result;
}

Model bodyPatchOfTheTeapot() {
  return Model({readModelFile(HAPTICD_SOURCE_DIR "/config/models/teapot.yaml").surfaces[4]});
}

TEST(Walks, NoTrackIsLostFarOutsideOrDeepInside) {
  std::vector<std::pair<double, Model>> models;
  for (const auto& [name, r] : {std::pair("cylinder", 0.04), {"torus", 0.02}, {"goblet", 0.02}})
    models.emplace_back(r, solid(name));
  models.emplace_back(0.04, bodyPatchOfTheTeapot());
  for (std::size_t m = 0; m < models.size(); ++m) {
    const auto& [r, model] = models[m];
    int judged = 0;
    for (double share : {-0.9, -0.5, -0.1, 0.5, 1.0, 1.5, 2.0})
      for (int patch = 0; patch < std::min(model.patchCount(), 5); ++patch) {
        const StandOff result = standOff(model, patch, share * r, 2);
        EXPECT_LE(result.longest, kSearchTicks) << m << ' ' << share << " R, patch " << patch;
        EXPECT_LE(result.worst, 3e-5) << m << ' ' << share << " R, patch " << patch;
        judged += result.judged;
      }
    EXPECT_GT(judged, 1000) << m;
  }
}

TEST(Walks, ContactOnSmoothPatchesIsGoodToANanometre) {
  std::vector<Model> models;
  for (const char* name : {"cylinder", "torus", "sphere", "goblet"}) models.push_back(solid(name));
  models.push_back(bodyPatchOfTheTeapot());
  for (std::size_t m = 0; m < models.size(); ++m)
    for (double offset : {-0.0025, -0.001, 0.001, 0.0025})
      for (int patch = 0; patch < std::min(models[m].patchCount(), 8); ++patch) {
        const StandOff result = standOff(models[m], patch, offset, 0.3);
        EXPECT_LE(result.worst, 1e-9) << m << ' ' << offset << ", patch " << patch;
      }
}

/// A surface that does not hold the nearest foot is followed over its seam all the same.
TEST(Walks, AFootThatWaitsGoesOnOverTheSeam) {
  const Model model = solid("cylinder");
  Tracer tracer(model);
  Found found;
  for (int tick = 0; tick < 40; ++tick) {  // over the bottom beside the seam of the round face, then up along that
    const double x = std::min(-0.006 + 1e-3 * tick, 0.006);
    const Vector3d p(x, -0.0485 + 2e-4 * std::max(tick - 12, 0), 0.0365);
    if (tick == 0) {
      model.search(p, 0.15, found);
      offer(found, tracer);
    }
    const Foot foot = tracer.step(p);
    EXPECT_NEAR(foot.depth, -signedDistance("cylinder", p), 1e-9) << tick;
  }
}

/// The inside of a box is a room: its corners are concave.
TEST(Walks, DeepCornersDoNotTrapTheProbe) {
  std::vector<spline::SurfaceData> faces = readModelFile(HAPTICD_SOURCE_DIR "/config/models/box.yaml").surfaces;
  for (auto& face : faces) face.reversed = !face.reversed;
  const Model room(faces);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.2, 1);
  for (int n = 0; n < 20; ++n) {
    Tracer tracer(room);
    Found found;
    const Vector3d out(share(random), share(random), share(random));
    Vector3d last = Vector3d::Zero();
    for (int tick = 0; tick <= 2000; ++tick) {  // 20 mm beyond the corner and back on another way
      const double t = tick <= 1000 ? 1e-3 * tick : 2 - 1e-3 * tick;
      const Vector3d along = tick <= 1000 ? out : Vector3d(out.y(), out.z(), out.x());
      const Vector3d deepest = Vector3d::Constant(0.05) + 0.02 * out;
      const Vector3d p = deepest - 0.04 * (1 - t) * along;
      if (tick % kSearchTicks == 0) {
        room.search(p, 0.15, found);
        offer(found, tracer);
      }
      const Foot foot = tracer.step(p);
      const Vector3d outside = (p - Vector3d::Constant(0.05)).cwiseMax(0);
      const Vector3d push = foot.depth > 0 ? Vector3d(foot.depth * foot.normal) : Vector3d::Zero();
      EXPECT_LT((push + outside).norm(), 1e-8) << n << ' ' << tick;  // straight back into the room
      if (tick > 0) {
        EXPECT_LT((push - last).norm(), 8e-5);
      }
      last = push;
    }
  }
}

}  // namespace
}  // namespace hapticd::trace
