// SPDX-License-Identifier: MIT
// The contact of a ball is compared with the offset surface of worlds whose offset surface is known.
#include "kernels/contact/ball_proxy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace hapticd::contact {
namespace {

using Eigen::Vector3d;

/// A solid with a foot for each point, and the nearest place for the centre of a ball.
struct World {
  std::function<Foot(const Vector3d&)> foot_at;
  std::function<Vector3d(const Vector3d& p, double radius)> nearest_free;
};

Foot footOf(const Vector3d& p, const Vector3d& point, const Vector3d& normal) {
  Foot foot;
  foot.status = FootStatus::kNearest;
  foot.point = point;
  foot.normal = normal;
  foot.distance = (p - point).norm();
  foot.depth = normal.dot(p - point) < 0 ? foot.distance : -foot.distance;
  foot.evaluations = 1;
  return foot;
}

/// All but the common part of half-spaces is solid: a floor, a groove, a corner.
World hollow(const std::vector<HalfSpace>& faces) {
  const auto nearest_free = [faces](const Vector3d& p, double radius) {
    std::vector<HalfSpace> free;
    for (const HalfSpace& face : faces) free.push_back({face.normal, face.offset + radius});
    return nearestCommonPoint(free, p).point;
  };
  const auto foot_at = [faces, nearest_free](const Vector3d& p) {
    const HalfSpace* nearest = nullptr;
    for (const HalfSpace& face : faces)
      if (nearest == nullptr || face.height(p) < nearest->height(p)) nearest = &face;
    if (nearest->height(p) >= 0) return footOf(p, p - nearest->height(p) * nearest->normal, nearest->normal);
    const Vector3d point = nearest_free(p, 0);
    return footOf(p, point, (point - p).normalized());
  };
  return {foot_at, nearest_free};
}

/// A solid ball, or with `inside` the hollow within one.
World sphere(double size, bool inside) {
  const double out = inside ? -1 : 1;
  return {[=](const Vector3d& p) { return footOf(p, size * p.normalized(), out * p.normalized()); },
          [=](const Vector3d& p, double radius) {
            const double bound = size + out * radius;
            return out * (p.norm() - bound) >= 0 ? p : Vector3d(bound * p.normalized());
          }};
}

/// Thin nails, or with `along` wires in this direction. Nothing has an inside.
World nails(const std::vector<Vector3d>& points, const Vector3d& along) {
  const auto foot_at = [points, along](const Vector3d& p) {
    Vector3d best = Vector3d::Constant(1);
    for (Vector3d point : points) {
      point += along.dot(p - point) * along;
      if ((point - p).squaredNorm() < (best - p).squaredNorm()) best = point;
    }
    return footOf(p, best, (p - best).normalized());
  };
  return {foot_at, nullptr};
}

/// A solid cube about the origin; the walks do not go into it, where the nearest way out jumps from face to face.
World cube(double half) {
  const auto onto = [half](const Vector3d& p) { return Vector3d(p.cwiseMax(-half).cwiseMin(half)); };
  return {[onto](const Vector3d& p) { return footOf(p, onto(p), (p - onto(p)).normalized()); },
          [onto](const Vector3d& p, double radius) {
            const Vector3d out = p - onto(p);
            return out.norm() >= radius ? p : Vector3d(onto(p) + radius * out.normalized());
          }};
}

const HalfSpace kFloor{{0, 1, 0}, 0};
const HalfSpace kWall{{1, 0, 0}, -0.01};
const HalfSpace kSlope{Vector3d(-1, 0.5, 0.2).normalized(), -0.01};
constexpr double kRadius = 3e-3;

/// A probe that goes about `middle` in steps of up to 0.3 mm, never farther than `reach` from it, and only where it
/// may.
template <class May, class Visit>
void walk(const Vector3d& middle, double reach, int ticks, const May& may, const Visit& visit) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  Vector3d p = middle, way(0, 0, 0);
  for (int i = 0; i < ticks; ++i) {
    way = 0.95 * way + 3e-5 * Vector3d(normal(random), normal(random), normal(random)) - 1e-3 * (p - middle);
    way *= std::min(1.0, 3e-4 / way.norm());
    if ((p + way - middle).norm() > reach || !may(p + way)) {
      way = Vector3d::Zero();
      continue;
    }
    p += way;
    visit(p);
  }
}

struct Seen {
  double worst = 0;    ///< [m] distance of the proxy from the nearest free place
  double mean = 0;     ///< [m] mean of this distance in contact
  double deepest = 0;  ///< [m] how far the proxy's ball was in the solid
  double feet = 0;     ///< mean number of feet of a tick in contact
  int contacts = 0;
};

Seen compare(const World& world, const Vector3d& middle, double reach, double outside = -1) {
  BallProxy ball;
  Seen seen;
  const auto may = [&](const Vector3d& p) { return -world.foot_at(p).depth > outside; };
  walk(middle, reach, 50'000, may, [&](const Vector3d& p) {
    const Foot foot = ball.step(world.foot_at, p, kRadius);
    const Vector3d truth = world.nearest_free(p, kRadius);
    if (!(foot.depth > 0)) {
      seen.worst = std::max(seen.worst, (truth - p).norm());
      EXPECT_NEAR(-foot.depth, world.foot_at(p).distance - kRadius, 1e-12);
      return;
    }
    const Vector3d centre = p + foot.depth * foot.normal;
    seen.worst = std::max(seen.worst, (centre - truth).norm());
    seen.deepest = std::max(seen.deepest, kRadius + world.foot_at(centre).depth);
    seen.mean += (centre - truth).norm();
    seen.feet += foot.evaluations;
    ++seen.contacts;
  });
  seen.mean /= std::max(seen.contacts, 1);
  seen.feet /= std::max(seen.contacts, 1);
  return seen;
}

TEST(BallProxy, RestsOnAFloorWithOneFootATick) {
  const Seen seen = compare(hollow({kFloor}), {0, 2e-3, 0}, 8e-3);
  EXPECT_GT(seen.contacts, 10'000);
  EXPECT_LT(seen.worst, 1e-12);
  EXPECT_LT(seen.feet, 1.01);
}

TEST(BallProxy, RestsAgainstEveryFaceOfAGrooveAndACorner) {
  for (const auto& faces :
       {std::vector{kFloor, kWall}, std::vector{kSlope, kFloor}, std::vector{kFloor, kWall, kSlope}}) {
    const World world = hollow(faces);
    Vector3d into(0, 0, 0);  // all faces
    for (const HalfSpace& face : faces) into -= face.normal;
    const Seen seen = compare(world, world.nearest_free(into, kRadius) + 1e-3 * into, 5e-3);
    EXPECT_GT(seen.contacts, 10'000);
    EXPECT_LT(seen.worst, 1e-8);
    EXPECT_LT(seen.deepest, 1e-8);
    EXPECT_LT(seen.feet, 5);
  }
}

/// The walks go 0.3 mm a tick. The second one goes nearly through the ball's radius, over sharp edges: there the proxy
/// is a tick behind now and then.
TEST(BallProxy, RollsOverRoundAndSharpConvexPlaces) {
  const struct {
    double outside, worst, mean;  ///< [m]
  } reaches[] = {{1.5e-3, 2e-6, 2e-8}, {3e-4, 1e-3, 1e-6}};
  for (const auto& [world, middle] :
       {std::pair{sphere(0.01, false), Vector3d(0, 0.012, 0)}, std::pair{cube(0.01), Vector3d(0.0105, 0.0115, 0.002)},
        std::pair{cube(0.01), Vector3d(0.011, 0.0105, 0.0108)}})
    for (const auto& reach : reaches) {
      const Seen seen = compare(world, middle, 2.5e-3, reach.outside);
      EXPECT_GT(seen.contacts, 10'000);
      EXPECT_LT(seen.deepest, 1e-8);
      EXPECT_LT(seen.worst, reach.worst);
      EXPECT_LT(seen.mean, reach.mean);
      EXPECT_LT(seen.feet, 4);
    }
}

/// A bowl in which the ball fits, to the depth of its own radius: there its bottom is less round than the press is
/// deep.
TEST(BallProxy, RestsInABowl) {
  for (const double size : {0.03, 0.01, 0.0032}) {
    const Seen seen = compare(sphere(size, true), {0, -size, 0}, 2.5e-3);
    EXPECT_GT(seen.contacts, 10'000);
    EXPECT_LT(seen.deepest, 1e-7);
    EXPECT_LT(seen.worst, 1e-4);
    EXPECT_LT(seen.mean, 1e-6);
  }
}

/// A pin of 2 mm goes in where a ball of 6 mm stays above, on the rims.
TEST(BallProxy, DoesNotGoIntoASlotNarrowerThanItself) {
  const double half = 1e-3;
  const World slot{[=](const Vector3d& p) {
                     const double rim = std::copysign(half, p.x());
                     if (std::abs(p.x()) > half) return footOf(p, {p.x(), 0, p.z()}, {0, 1, 0});
                     const Vector3d point(rim, std::min(p.y(), 0.0), p.z());
                     return footOf(p, point, (p - point).normalized());
                   },
                   nullptr};
  BallProxy ball;
  Foot foot;
  for (int i = 0; i <= 1000; ++i) foot = ball.step(slot.foot_at, {2e-4, 5e-3 - 1e-5 * i, 0}, kRadius);
  const Vector3d centre = Vector3d(2e-4, -5e-3, 0) + foot.depth * foot.normal;
  EXPECT_NEAR(centre.y(), std::sqrt(kRadius * kRadius - half * half), 1e-7);
  EXPECT_NEAR(centre.x(), 0, 1e-6);
}

/// Between two plates that are nearer than its diameter there is no place for the ball.
TEST(BallProxy, FeelsNothingWhereItBeginsAndDoesNotFit) {
  const World gap = hollow({{{0, 1, 0}, -2e-3}, {{0, -1, 0}, -2e-3}});
  const World wide = hollow({{{0, 1, 0}, -2e-3}, {{0, -1, 0}, -5e-3}});
  BallProxy ball;
  for (int i = 0; i < 100; ++i) {
    const Foot foot = ball.step(gap.foot_at, {1e-4 * i, 1e-5 * i, 0}, kRadius);
    EXPECT_LE(foot.depth, 0);
    EXPECT_EQ(foot.status, FootStatus::kDegraded);
  }
  EXPECT_LE(ball.step(wide.foot_at, {0.01, 0, 0}, kRadius).depth, 0) << "it fits 1 mm above the probe";
  EXPECT_LE(ball.step(wide.foot_at, {0.01, 1.5e-3, 0}, kRadius).depth, 0) << "it fits";
  EXPECT_NEAR(ball.step(wide.foot_at, {0.01, 0, 0}, kRadius).depth, 1e-3, 1e-12);
}

/// Two rims hold a ball that is pulled along the slot. It follows at once, and rests as soon as the probe rests.
TEST(BallProxy, FollowsAndRestsOnTwoRims) {
  const World rims = nails({{-1e-3, 0, 0}, {1e-3, 0, 0}}, {0, 0, 1});
  BallProxy ball;
  Foot foot;
  const auto centre_over = [&](const Vector3d& p) {
    foot = ball.step(rims.foot_at, p, kRadius);
    return Vector3d(p + foot.depth * foot.normal);
  };
  for (int i = 0; i <= 500; ++i) centre_over({2e-4, 5e-3 - 2e-5 * i, 0});
  for (int i = 0; i <= 500; ++i) {
    const Vector3d p(2e-4 * std::sin(0.1 * i), -5e-3, 1e-4 * i);
    EXPECT_LT((centre_over(p) - Vector3d(0, std::sqrt(8) * 1e-3, p.z())).norm(), 1e-7);
  }
  const Vector3d p(0, -5e-3, 0.05);
  for (int i = 0; i < 3; ++i) centre_over(p);
  const Vector3d centre = centre_over(p);
  for (int i = 0; i < 10; ++i) EXPECT_LT((centre_over(p) - centre).norm(), 1e-12);
}

/// A kernel with too few evaluations may return a foot that is not the nearest. The ball then seems to be free where it
/// is not. The next feet tell.
TEST(BallProxy, RecoversFromAWrongFoot) {
  const World groove = hollow({{Vector3d(0.98, 0.2, 0).normalized(), 0}, {Vector3d(-0.98, 0.2, 0).normalized(), 0}});
  BallProxy ball;
  Foot foot;
  for (int i = 0; i < 200; ++i) {
    const Vector3d p(3e-4, 0.02 - 1e-4 * i, 0);
    foot = ball.step(
        [&](const Vector3d& x) {
          Foot at = groove.foot_at(x);
          if (i != 100) return at;
          at.point += (kRadius - at.distance) * (at.point - x).normalized();  // it seems to touch just so
          at.distance = kRadius;
          at.depth = -kRadius;
          at.status = FootStatus::kDegraded;
          return at;
        },
        p, kRadius);
    if (i == 100 || !(foot.depth > 0)) continue;
    EXPECT_LT((p + foot.depth * foot.normal - groove.nearest_free(p, kRadius)).norm(), 1e-7) << i;
  }
}

/// However wrong the feet are, the planes of a narrow groove do not throw the ball far away.
TEST(BallProxy, StaysNearIfManyFeetAreWrong) {
  const World groove = hollow({{Vector3d(1, 0.02, 0).normalized(), 0}, {Vector3d(-1, 0.021, 0.001).normalized(), 0}});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> wrong(-1e-3, 1e-3);
  BallProxy ball;
  double farthest = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p(2e-3 * std::sin(0.01 * i), std::max(0.2 - 1e-4 * i, 0.13), 0);
    const Foot foot = ball.step(
        [&](const Vector3d& x) {
          const Foot at = groove.foot_at(x);
          return random() % 2 == 0
                     ? at
                     : footOf(x, at.point + Vector3d(wrong(random), wrong(random), wrong(random)), at.normal);
        },
        p, kRadius);
    farthest = std::max(farthest, foot.depth);
  }
  EXPECT_LT(farthest, 0.1);
}

/// The spring of a ball on a bed of nails gets longer only by the motion of the hand, so a closed path gives the hand
/// no energy. Where the hand rests, the ball rests.
TEST(BallProxy, GivesNoEnergyAndRests) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<Vector3d> points;
  for (int i = 0; i < 200; ++i) points.push_back(8e-3 * Vector3d(share(random), 0.1 * share(random), share(random)));
  const World bed = nails(points, Vector3d::Zero());
  for (const double radius : {1e-3, 3e-3, 2e-2}) {
    BallProxy ball;
    Vector3d centre(0, 0, 0);
    int ticks = 0, contacts = 0;
    ball.step(bed.foot_at, {0, 2 * radius + 1e-3, 0}, radius);
    walk(
        {0, 0.5 * radius, 0}, 8e-3, 20'000, [](const Vector3d&) { return true; },
        [&](const Vector3d& p) {
          const auto step = [&] {
            const Foot foot = ball.step(bed.foot_at, p, radius);
            return Vector3d(p + std::max(foot.depth, 0.0) * foot.normal);
          };
          const double before = (centre - p).norm();
          centre = step();
          EXPECT_LT((centre - p).norm(), ticks++ > 0 ? before + 1e-7 : 1) << radius << ' ' << ticks;
          EXPECT_LT(radius - bed.foot_at(centre).distance, 1e-4);
          contacts += centre != p;
          if (ticks % 100 != 0) return;
          for (int i = 0; i < 30; ++i) step();
          centre = step();
          for (int i = 0; i < 3; ++i) EXPECT_LT((step() - centre).norm(), 1e-8) << radius << ' ' << ticks;
        });
    EXPECT_GT(contacts, 5'000);
  }
}

}  // namespace
}  // namespace hapticd::contact
