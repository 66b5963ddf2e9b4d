// SPDX-License-Identifier: MIT
/// Walks in and out of shells that are felt from both sides. A way in that is not seen turns a shell around.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "hand.hpp"
#include "shapes.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::trace {
namespace {

using contact::Sides;
using Eigen::Vector3d;

/// A value [m] that is below 0 inside a solid, and about the distance near its surface.
using Height = double (*)(const Vector3d&);

double overSphere(const Vector3d& p) {
  return p.norm() - 0.05;
}
double overTorus(const Vector3d& p) {  // about y
  return std::hypot(std::hypot(p.x(), p.z()) - 0.05, p.y()) - 0.02;
}

double overCylinder(const Vector3d& p) {  // about y
  const double out = std::hypot(p.x(), p.z()) - 0.04, up = std::abs(p.y()) - 0.05;
  return std::hypot(std::max(out, 0.0), std::max(up, 0.0)) + std::min(std::max(out, up), 0.0);
}
double overBox(const Vector3d& p) {
  const Vector3d out = p.cwiseAbs() - Vector3d::Constant(0.05);
  return out.cwiseMax(0).norm() + std::min(out.maxCoeff(), 0.0);
}

/// Walks along a shell that is felt from both sides, mostly along its surface and in and out of it. The start is
/// outside, so a probe inside is always pushed out: a way in that is not seen would turn the shell around.
int ticksOnTheWrongSide(const std::string& file, Height height, const Vector3d& start, unsigned seed) {
  const Model model(readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + file).surfaces);
  Hand hand{model};
  hand.options = holding(Sides::kBoth);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  Vector3d p = start;
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    wrong += (hand.at(p).depth > 0) != (height(p) < 0);
    Vector3d out;
    for (int axis = 0; axis < 3; ++axis) out[axis] = (height(p + 1e-7 * Vector3d::Unit(axis)) - height(p)) / 1e-7;
    const Vector3d any(normal(random), normal(random), normal(random));
    const Vector3d along = (any - any.dot(out) * out).normalized();
    const Vector3d next =
        p + std::pow(10, -5 + 1.7 * share(random)) * (along + (0.1 * normal(random) - 50 * height(p)) * out);
    const bool at_pole = std::hypot(next.x(), next.z()) < 0.002;
    if (std::abs(height(next)) > 1e-8 && !at_pole) p = next;
  }
  return wrong;
}

TEST(Held, AShellIsEnteredByPathsThatGrazeIt) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    EXPECT_EQ(ticksOnTheWrongSide("sphere.yaml", overSphere, {0.051, 0, 0}, seed), 0) << seed;
    EXPECT_EQ(ticksOnTheWrongSide("torus.yaml", overTorus, {0.071, 0, 0}, seed), 0) << seed;
  }
}

/// What was wrong on a walk.
struct Wrong {
  int side = 0;       ///< ticks in which a certain foot was felt from the wrong side
  int foot = 0;       ///< ticks in which a certain foot was not the nearest point
  int uncertain = 0;  ///< ticks in which the foot was not certain
};

/// A shell, and a point of it about which the walks go.
struct Spot {
  const Model& model;
  std::function<double(const Vector3d&)> height;
  Vector3d home, out;  ///< the point, and the direction away from the front
  Method method = Method::kNewton;
};

/// Walks in and out of a shell, from outside, within about `reach` of a point of it, where firstCrossing() may not find
/// the way in.
Wrong walkAbout(const Spot& spot, double reach, unsigned seed) {
  Hand hand{spot.model};
  hand.options = holding(Sides::kBoth);
  hand.options.method = spot.method;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.1, 1);
  std::normal_distribution<double> normal;
  Wrong wrong;
  Vector3d p = spot.home + 0.5 * reach * spot.out;
  for (int i = 0; i < 500; ++i) {
    const Foot foot = hand.at(p);
    const double height = spot.height(p);
    if (foot.status == FootStatus::kDegraded) {
      ++wrong.uncertain;
    } else {
      wrong.side += (foot.depth > 0) != (height < 0);
      wrong.foot += spot.method == Method::kNewton && foot.status == FootStatus::kNearest &&
                    std::abs(foot.distance - std::abs(height)) > 1e-8;
    }
    Vector3d step;
    for (double& one : step) one = normal(random);
    step *= 0.5 * reach * share(random);
    step -= 0.5 * (p - spot.home);
    const double along = spot.out.dot(step) + 0.3 * spot.out.dot(p - spot.home);
    step -= (along - 0.1 * reach * normal(random)) * spot.out;  // mostly along the shell
    if (std::abs(spot.height(p + step)) > 1e-8) p += step;
  }
  return wrong;
}

/// Makes 60 walks about a point, with steps of up to 5 um to 1.2 mm, together 30000 ticks.
void expectRight(const Spot& spot, const std::string& name) {
  Wrong sum;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Wrong wrong = walkAbout(spot, std::pow(10, -5 + 0.04 * seed), seed);
    sum = {sum.side + wrong.side, sum.foot + wrong.foot, sum.uncertain + wrong.uncertain};
  }
  EXPECT_EQ(sum.side, 0) << name << ' ' << spot.home.transpose();
  EXPECT_EQ(sum.foot, 0) << name << ' ' << spot.home.transpose();
  EXPECT_LE(sum.uncertain, 600) << name << ' ' << spot.home.transpose();  // a corner takes many evaluations
}

void expectRightIn(const std::string& file, Height height, const Vector3d& home, const Vector3d& out) {
  const Model model(readModelFile(HAPTICD_SOURCE_DIR "/config/models/" + file).surfaces);
  expectRight({model, height, home, out}, file);
}

TEST(Held, AShellIsEnteredAtItsPolesAndSeams) {
  expectRightIn("sphere.yaml", overSphere, {0, 0.05, 0}, {0, 1, 0});  // a pole
  expectRightIn("sphere.yaml", overSphere, {0, 0, 0.05}, {0, 0, 1});  // a seam
  expectRightIn("torus.yaml", overTorus, {0, 0, 0.03}, {0, 0, -1});   // two seams meet
  expectRightIn("torus.yaml", overTorus, {0.03, 0, 0}, {-1, 0, 0});
}

TEST(Held, AShellKeepsItsSideAtEdgesAndCorners) {
  const double half = std::sqrt(0.5), third = std::sqrt(1.0 / 3);
  expectRightIn("box.yaml", overBox, {0.05, 0.05, 0}, {half, half, 0});
  expectRightIn("box.yaml", overBox, {0.05, 0.05, 0.05}, {third, third, third});
  expectRightIn("cylinder.yaml", overCylinder, {0.04, 0.05, 0}, {0.04 / 0.064, 0.05 / 0.064, 0});
  expectRightIn("cylinder.yaml", overCylinder, {0, -0.05, 0}, {0, -1, 0});  // the pole of a flat lid
}

/// Two plates of 50 mm that meet on the z axis at an angle [rad], symmetric about the y axis, with the front above.
std::vector<spline::SurfaceData> folded(double angle) {
  const double x = 0.05 * std::sin(angle / 2), y = -0.05 * std::cos(angle / 2);
  const Vector3d fold(0, 0, -0.05), along(0, 0, 0.05), left(-x, y, -0.05), right(x, y, -0.05);
  return {flat(left, {-x, y, 0.05}, fold), flat(fold, along, right)};
}

/// The distance to such plates, negative behind them.
double overFold(double angle, const Vector3d& p) {
  const Vector3d normal(std::cos(angle / 2), std::sin(angle / 2), 0), plate(normal.y(), -normal.x(), 0);
  const Vector3d q(std::abs(p.x()), p.y(), p.z());
  const double over = q.dot(normal);
  return q.dot(plate) > 0 ? over : std::copysign(std::hypot(q.x(), q.y()), over);
}

TEST(Held, AnOpenShellIsEnteredAtItsFolds) {
  for (const double degrees : {90.0, 150.0, 175.0, 200.0, 270.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const auto height = [=](const Vector3d& p) { return overFold(angle, p); };
    const Model model(folded(angle));
    expectRight({model, height, {0, 0, 0}, {0, 1, 0}}, "a fold of " + std::to_string(degrees) + " degrees");
  }
}

/// Parallelograms round the origin, between rays of 50 mm.
struct Corner {
  std::vector<Vector3d> rays;

  std::vector<spline::SurfaceData> surfaces() const {
    std::vector<spline::SurfaceData> all;
    for (std::size_t i = 0; i < rays.size(); ++i) all.push_back(flat({0, 0, 0}, rays[(i + 1) % rays.size()], rays[i]));
    return all;
  }
  /// How often the way from a to b crosses the parallelograms; -1 if it comes nearer than 10 nm to one of their rays.
  int crossings(const Vector3d& a, const Vector3d& b) const {
    int count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Eigen::Matrix3d frame;
      frame << rays[i], rays[(i + 1) % rays.size()], a - b;
      const Vector3d at = frame.partialPivLu().solve(a);
      if (!(at.z() > 0 && at.z() < 1)) continue;
      const double nearest = std::min(at.x(), at.y()) * 0.05;
      if (std::abs(nearest) < 1e-8) return -1;
      count += nearest > 0;
    }
    return count;
  }
  double distance(const Vector3d& p) const {
    double least = p.norm();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Vector3d &u = rays[i], &v = rays[(i + 1) % rays.size()], n = u.cross(v).normalized();
      least = std::min(least, (p - std::max(0.0, p.dot(u) / u.squaredNorm()) * u).norm());
      if (u.cross(p).dot(n) > 0 && p.cross(v).dot(n) > 0) least = std::min(least, std::abs(p.dot(n)));
    }
    return least;
  }
};

/// Walks in and out near a corner by steps that cross at most one of the parallelograms.
int ticksOnTheWrongSide(const Corner& corner, const Vector3d& out, unsigned seed) {
  const Model model(corner.surfaces());
  Hand hand{model};
  hand.options = holding(Sides::kBoth);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const double reach = std::pow(10, -5 + 0.1 * seed);
  Vector3d p = 1.5 * reach * out;
  bool behind = false;
  int wrong = 0;
  for (int tick = 0; tick < 500; ++tick) {
    const Foot foot = hand.at(p);
    wrong += foot.status != FootStatus::kDegraded && (foot.depth > 0) != behind;
    Vector3d next = 0.7 * p;
    for (double& one : next) one += 0.5 * reach * normal(random);
    const int crossings = corner.crossings(p, next);
    if (crossings < 0 || crossings > 1 || corner.distance(next) < 1e-8) continue;
    behind = behind != (crossings == 1);
    p = next;
  }
  return wrong;
}

TEST(Held, AnOpenShellIsEnteredAtItsCorners) {
  const auto star = [](int count, double rise, double turn) {
    Corner corner;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      corner.rays.push_back(0.05 * Vector3d(std::cos(angle), i % 2 == 0 ? rise : turn * rise, -std::sin(angle)));
    }
    return corner;
  };
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_EQ(ticksOnTheWrongSide(star(4, -0.5, 1), {0, 1, 0}, seed), 0) << "pyramid " << seed;
    EXPECT_EQ(ticksOnTheWrongSide(star(4, 0.5, -1), {0, 1, 0}, seed), 0) << "saddle " << seed;
    EXPECT_EQ(ticksOnTheWrongSide(star(4, 0.1, -1), {0, 1, 0}, seed), 0) << "flat saddle " << seed;
    EXPECT_EQ(ticksOnTheWrongSide(star(6, 0.3, -1), {0, 1, 0}, seed), 0) << "monkey saddle " << seed;
  }
}

TEST(Held, AFoldWithinASurfaceIsFeltLikeOneOfTwo) {
  for (const double degrees : {60.0, 90.0, 150.0, 200.0, 270.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const auto height = [=](const Vector3d& p) { return overFold(angle, p); };
    const Model model({foldedByACusp(angle)});
    if (degrees > 60) expectRight({model, height, {0, 0, 0}, {0, 1, 0}}, "a cusp of " + std::to_string(degrees));
    for (const double aside : {-3e-4, 0.0, 1e-5}) {
      Hand hand{model};
      hand.walk({aside, 0.02, 1e-3}, {aside, -0.001, 1e-3}, 1e-4, [&](const Foot& foot, const Vector3d& p) {
        ASSERT_EQ(foot.status, FootStatus::kNearest) << degrees << ' ' << p.transpose();
        ASSERT_NEAR(foot.depth, -height(p), 1e-8) << degrees << ' ' << p.transpose();
      });
    }
  }
}

/// Other shells of the model change nothing, nor does it matter how the fold lies in space.
TEST(Held, AnOpenShellAmongOthersIsEnteredAtItsFolds) {
  const double angle = 150 * std::numbers::pi / 180;
  const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d::Ones()).matrix();
  std::vector<spline::SurfaceData> surfaces = folded(angle);
  for (spline::SurfaceData& surface : surfaces)
    for (Vector3d& point : surface.points) point = turn * Vector3d(point.x(), point.y(), 4 * point.z());
  for (int i = 0; i < 200; ++i) {
    const Vector3d corner(0.3, 0.3 + 0.02 * i, 0.3);
    surfaces.push_back(flat(corner, corner + Vector3d(0.01, 0, 0), corner + Vector3d(0, 0.01, 0)));
  }
  const Model model(surfaces);
  const auto height = [&](const Vector3d& p) { return overFold(angle, turn.transpose() * p); };
  expectRight({model, height, {0, 0, 0}, turn.col(1)}, "a fold among other sheets");
}

/// A sheet of 1 mm pitch, rolled about the z axis with a radius of 10 mm and more.
spline::SurfaceData rolled(double pitch) {
  constexpr int kTurn = 180, kCount = 3 * kTurn + 4;
  spline::SurfaceData data;
  data.degree = {3, 1};
  data.knots[0].assign(4, 0);
  for (int i = 1; i < kCount - 3; ++i) data.knots[0].push_back(i / (kCount - 3.0));
  data.knots[0].insert(data.knots[0].end(), 4, 1);
  data.knots[1] = {0, 0, 1, 1};
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * std::numbers::pi * i / kTurn, radius = 0.01 + pitch * i / kTurn;
    for (const double z : {-0.02, 0.02})
      data.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return data;
}

/// A probe between two layers goes by less than their distance a tick, along them and from one to the other.
TEST(Held, ALayerOfARolledSheetIsNotEnteredBesideIt) {
  constexpr double kPitch = 1e-3;
  const Model model({rolled(kPitch)});
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double step : {1e-4, 3e-4}) {
    Hand hand{model};
    hand.options = holding(Sides::kBoth);
    double angle = 3 * std::numbers::pi, share = 0.5;
    int entered = 0;
    for (int i = 0; i < 5000; ++i) {
      const double radius = 0.01 + kPitch * (angle / (2 * std::numbers::pi) + share);
      entered += hand.at({radius * std::cos(angle), radius * std::sin(angle), 0}).depth > 0;
      angle = std::clamp(angle + std::clamp(normal(random), -2.0, 2.0) * step / radius, 4.0, 11.0);
      share = std::clamp(share + 0.5 * normal(random) * step / kPitch, 0.15, 0.85);
    }
    EXPECT_EQ(entered, 0) << step;
  }
}

TEST(Held, AnOpenShellIsEnteredAtItsPole) {
  const double r = 0.05;
  const Model dome({turned({{r, 0, 1}, {r, r, std::sqrt(0.5)}, {0, r, 1}})});
  for (const Method method : {Method::kNewton, Method::kDirect})
    expectRight({dome, overSphere, {0, r, 0}, {0, 1, 0}, method}, "a dome");
}

/// Inside a cone, the point of the far wall that is nearest to the probe along that wall is a saddle of the distance.
TEST(Held, AnOpenShellIsEnteredAtItsApex) {
  const Model cone({turned({{0.05, -0.05, 1}, {0, 0, 1}})});  // of 45 degrees, with its apex at the origin
  const auto height = [](const Vector3d& p) {
    const double radius = std::hypot(p.x(), p.z()), over = (radius + p.y()) / std::numbers::sqrt2;
    return radius > p.y() ? over : p.norm();
  };
  for (const Method method : {Method::kNewton, Method::kDirect})
    expectRight({cone, height, {0, 0, 0}, {0, 1, 0}, method}, "a cone");
}

/// A path that leads round the end of a sheet enters nothing, wherever the probe was before.
TEST(Held, AnOpenShellIsNotEnteredRoundItsEnd) {
  const Model plate({flat({0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0})});  // the front is above
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto about = [&](const Vector3d& home, double reach) {
    return Vector3d(home + reach * Vector3d(normal(random), normal(random), normal(random)));
  };
  int around = 0;
  for (int i = 0; i < 6000; ++i) {
    const Vector3d home(0.1, 0, i % 2 == 0 ? 0.05 : 0.1);  // an end and a corner
    const double reach = std::pow(10, -5 + i % 3);
    const Vector3d from = about(home, reach), to = about(i % 4 < 2 ? from : home, reach);
    const Vector3d met = from + (to - from) * from.y() / (from.y() - to.y());
    if (from.y() * to.y() > 0 || std::max(met.x(), met.z()) < 0.1 + 1e-7) continue;
    for (const Method method : {Method::kNewton, Method::kDirect}) {
      Hand hand{plate};
      hand.options = holding(Sides::kBoth);
      hand.options.method = method;
      for (int tick = 0; tick < 8; ++tick) hand.at(from);
      EXPECT_LE(hand.at(to).depth, 0) << from.transpose() << " to " << to.transpose();
    }
    ++around;
  }
  EXPECT_GT(around, 1000);
}

}  // namespace
}  // namespace hapticd::trace
