// SPDX-License-Identifier: MIT
/// Contacts that are held: thin walls, edges, fast probes, starts inside.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "hand.hpp"
#include "shapes.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::trace {
namespace {

using contact::Sides;
using Eigen::Vector3d;

/// A box with its corner at `lo`; outward normals.
std::vector<spline::SurfaceData> box(const Vector3d& lo, const Vector3d& size) {
  const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z()), hi = lo + size;
  return {flat(hi, hi - x, hi - y), flat(lo, lo + y, lo + x), flat(hi, hi - y, hi - z),
          flat(lo, lo + z, lo + y), flat(hi, hi - z, hi - x), flat(lo, lo + x, lo + z)};
}

const Vector3d kPlate(0.1, 0.1, 0.004);

TEST(Held, AThinWallPushesBackToTheSideItWasEnteredFrom) {
  const Model model(box({0, 0, 0}, kPlate));
  for (const double step : {1e-5, 1e-4, 1e-3, 3e-3}) {  // up to 3 m/s at 1000 Hz
    Hand hand{model};
    bool was_held = false;
    hand.walk({0.05, 0.05, 0.010}, {0.05, 0.05, -0.012}, step, [&](const Foot& foot, const Vector3d& p) {
      ASSERT_NEAR(foot.depth, 0.004 - p.z(), 1e-9);  // through the far side and beyond
      ASSERT_NEAR(foot.normal.z(), 1, 1e-9);
      ASSERT_LE(foot.evaluations, 12);
      if (p.z() > 0.0021) {
        ASSERT_EQ(foot.status, FootStatus::kNearest);
      }
      was_held = was_held || foot.status == FootStatus::kHeld;
    });
    EXPECT_TRUE(was_held) << step;
    hand.walk({0.05, 0.05, -0.012}, {0.05, 0.05, 0.010}, step, [&](const Foot& foot, const Vector3d& p) {
      ASSERT_NEAR(foot.depth, 0.004 - p.z(), 1e-9);  // and out again by the way it came
    });
    EXPECT_EQ(hand.at({0.05, 0.05, 0.010}).status, FootStatus::kNearest);
  }
}

TEST(Held, WithoutHysteresisIsTheNearestFace) {
  const Model model(box({0, 0, 0}, kPlate));
  Hand hand{model};
  hand.options = holding(Sides::kFront, 0);
  hand.walk({0.05, 0.05, 0.010}, {0.05, 0.05, -0.012}, 1e-4, [&](const Foot& foot, const Vector3d& p) {
    ASSERT_NEAR(foot.depth, std::min(p.z(), 0.004 - p.z()), 1e-9);
    ASSERT_NE(foot.status, FootStatus::kHeld);
  });
}

TEST(Held, HysteresisSaysHowMuchNearerAnotherFaceMustBe) {
  const Model model = solid("box");
  for (const double hysteresis : {0.0, 0.002, 0.5}) {
    Hand hand{model};
    hand.options = holding(Sides::kFront, hysteresis);
    double changed = -1;  // in through the top, down beside the right face, 4 mm off it
    hand.walk({0.046, 0.051, 0}, {0.046, 0.011, 0}, 1e-5, [&](const Foot& foot, const Vector3d& p) {
      if (changed < 0 && foot.normal.x() > 0.5) changed = 0.05 - p.y();
    });
    if (hysteresis > 0.1) {
      EXPECT_LT(changed, 0) << "pushed up all the way";
    } else {
      EXPECT_NEAR(changed, 0.004 + hysteresis, 1e-4);
    }
  }
}

/// A tick that begins outside and ends inside or behind a plate of 1 mm, in any direction and turned in any way.
TEST(Held, TheFirstFaceInTheWayIsEntered) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> any(0, 1);
  for (int turn = 0; turn < 10; ++turn) {
    const Eigen::Quaterniond R = Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
    std::vector<spline::SurfaceData> faces = box({0, 0, 0}, {0.1, 0.1, 0.001});
    for (spline::SurfaceData& face : faces)
      for (Vector3d& point : face.points) point = R * point;
    const Model model(faces);
    for (int i = 0; i < 200; ++i) {
      Hand hand{model};
      const bool below = i % 2 == 1;
      const double above = 1.5e-3 * share(random), deep = 3e-3 * share(random);
      const Vector3d start(0.1 * share(random), 0.1 * share(random), below ? -above : 0.001 + above);
      Vector3d end(start.x() + 0.002 * any(random), start.y() + 0.002 * any(random), below ? deep : 0.001 - deep);
      end.head<2>() = end.head<2>().cwiseMax(1e-4).cwiseMin(0.0999);
      hand.at(R * start);
      const Foot foot = hand.at(R * end);
      ASSERT_NEAR(foot.depth, deep, 1e-9) << turn << " " << i;
      ASSERT_NEAR((R.conjugate() * foot.normal).z(), below ? -1 : 1, 1e-9);
    }
  }
}

TEST(Held, IsReleasedOverAConvexEdge) {
  const Model model(box({0, 0, 0}, kPlate));
  Hand hand{model};
  const auto quiet = [](const Foot&, const Vector3d&) {};
  hand.walk({0.09, 0.05, 0.006}, {0.09, 0.05, -0.003}, 1e-4, quiet);  // beyond the far side
  hand.walk({0.09, 0.05, -0.003}, {0.11, 0.05, -0.003}, 1e-4, [&](const Foot& foot, const Vector3d& p) {
    if (p.x() < 0.1 - 1e-9) {
      ASSERT_NEAR(foot.depth, 0.007, 1e-9) << p.x();
      ASSERT_NEAR(foot.normal.z(), 1, 1e-9);
    } else if (p.x() > 0.1 + 1e-9) {
      ASSERT_LT(foot.depth, 0) << p.x();
      ASSERT_EQ(foot.status, FootStatus::kNearest);
    }
  });
}

/// A stair: the floor z = 0 before the wall x = 0.
std::vector<spline::SurfaceData> stair() {
  return {flat({0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}), flat({0, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1})};
}

/// Three cubes of 20 mm side by side in an L, whose inner corner is at (0.02, 0.02).
std::vector<spline::SurfaceData> block() {
  const double a = 0.02;
  const auto isCube = [](int i, int j) { return (i == 0 || j == 0) && i >= 0 && j >= 0 && i + j < 2; };
  std::vector<spline::SurfaceData> faces;
  for (const auto& [i, j] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1)}) {
    const auto cube = box({a * i, a * j, 0}, {a, a, a});
    const bool joined[6] = {false, false, isCube(i + 1, j), isCube(i - 1, j), isCube(i, j + 1), isCube(i, j - 1)};
    for (std::size_t face = 0; face < 6; ++face)
      if (!joined[face]) faces.push_back(cube[face]);
  }
  return faces;
}

/// A foot passes an inner corner within one step: over the middle cube, beyond the planes of both inner walls.
TEST(Held, IsNotReleasedAtAnInnerCornerOfItsFace) {
  const Model model(block());
  const Vector3d along = Vector3d(1, -1, 0).normalized(), inward = Vector3d(-1, -1, 0).normalized();
  for (const Sides sides : {Sides::kFront, Sides::kBoth})
    for (int i = 0; i < 60; ++i) {
      const double step = 1e-4, depth = i % 3 == 0 ? 1e-5 : 2e-3;
      const Vector3d over = Vector3d(0.02, 0.02, 0.02) + inward * (step * (0.01 + 0.01 * i));
      Hand hand{model};
      hand.options = holding(sides);
      const Vector3d start = over - along * (step * (20.3 + 0.01 * i)) - depth * Vector3d::UnitZ();
      hand.walk(start + 2 * depth * Vector3d::UnitZ(), start, step, [](const Foot&, const Vector3d&) {});
      hand.walk(start, start + 40 * step * along, step, [&](const Foot& foot, const Vector3d& p) {
        ASSERT_NEAR(foot.depth, depth, 1e-12) << i << ' ' << p.transpose();
        ASSERT_NEAR(foot.normal.z(), 1, 1e-12) << i << ' ' << p.transpose();
      });
    }
}

TEST(Held, RestsAgainstBothFacesOfAConcaveEdge) {
  const Model model(stair());
  Hand hand{model};
  hand.walk({0.02, 0.05, 0.002}, {0.02, 0.05, -0.002}, 1e-4, [](const Foot&, const Vector3d&) {});
  Foot foot;
  hand.walk({0.02, 0.05, -0.002}, {-0.003, 0.05, -0.002}, 1e-4, [&](const Foot& f, const Vector3d& p) {
    foot = f;
    ASSERT_NEAR(f.depth, std::hypot(0.002, std::max(0.0, -p.x())), 1e-9) << p.x();
  });
  EXPECT_NEAR((foot.point - Vector3d(0, 0.05, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(foot.normal.dot(Vector3d(3, 0, 2).normalized()), 1, 1e-9);
}

/// Round a smooth body pressed 1 mm deep: the foot and the normal never jump, whatever seams and poles are crossed.
TEST(Held, SlidesOverSeamsAndPolesWithoutAJump) {
  const Model model = solid("sphere");
  Hand hand{model};
  hand.at({0, 0, 0.0505});
  for (int i = 0; i <= 20000; ++i) {
    const double a = 1e-3 * i, b = 0.37 * a;  // a curve that winds about the ball
    const Vector3d n(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    const Foot foot = hand.at(0.049 * n);
    ASSERT_NEAR(foot.depth, 0.001, 1e-8) << i;
    ASSERT_LT((foot.normal - n).norm(), 1e-6) << i;
    ASSERT_EQ(foot.status, FootStatus::kNearest);
  }
}

/// A goblet's wall is thin: the contact of a hand that strolls along it changes by no more than the way it goes.
TEST(Held, FollowsARoundWallContinuously) {
  const Model model = solid("torus");
  Hand hand{model};
  Foot last;
  bool in = false;
  for (int i = 0; i <= 20000; ++i) {  // 5 mm deep, along and across the tube of 20 mm
    const double a = 1e-3 * i, b = 0.61 * a, r = i < 20 ? 0.021 - 3e-4 * i : 0.015;
    const Vector3d axis(std::cos(a), 0, std::sin(a));
    const Vector3d p = 0.05 * axis + r * (std::cos(b) * axis + Vector3d(0, std::sin(b), 0));
    const Foot foot = hand.at(p);
    ASSERT_NEAR(foot.depth, 0.02 - r, 1e-8) << i;
    if (in) {
      ASSERT_LT((foot.point - last.point).norm(), 2e-3) << i;
    }
    in = true;
    last = foot;
  }
}

TEST(Held, BeyondACentreOfCurvatureTheFootSlidesOffByItself) {
  const Model model = solid("sphere");
  Hand hand{model};
  Foot foot;
  hand.walk({0, 0.051, 0.0003}, {0.0002, -0.02, 0.0003}, 1e-4, [&](const Foot& f, const Vector3d&) { foot = f; });
  EXPECT_NEAR(foot.depth, 0.03, 1e-5);  // through the centre: the other side is the one to be pushed out of
  EXPECT_LT(foot.normal.y(), -0.9);
}

TEST(Held, AStartInsideAJumpAndALostSampleBeginOnTheNearestFace) {
  const Model model(box({0, 0, 0}, kPlate));
  Hand hand{model};
  const Vector3d low(0.05, 0.05, 0.001);
  EXPECT_NEAR(hand.at(low).normal.z(), -1, 1e-9);  // a start
  EXPECT_NEAR(hand.at(low).depth, 0.001, 1e-9);
  EXPECT_NEAR(hand.at({0.05, 0.05, 0.003}).depth, 0.003, 1e-9);  // held from there on
  EXPECT_EQ(hand.at({0.05, 0.05, 0.003}).status, FootStatus::kHeld);
  EXPECT_EQ(hand.at(Vector3d::Constant(std::nan(""))).status, FootStatus::kInvalid);
  EXPECT_NEAR(hand.at({0.05, 0.05, 0.003}).normal.z(), 1, 1e-9);
  hand.tracer.forgetContact();
  EXPECT_NEAR(hand.at(low).normal.z(), -1, 1e-9);
}

TEST(Held, ShellsAreFeltFromTheSideTheyWereEntered) {
  const Model model({flat({0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0})});
  for (const double side : {1.0, -1.0}) {
    Hand hand{model};
    hand.options = holding(Sides::kBoth);
    hand.walk({0.05, 0.05, 0.003 * side}, {0.05, 0.05, -0.02 * side}, 1e-4, [&](const Foot& foot, const Vector3d& p) {
      ASSERT_NEAR(foot.depth, -side * p.z(), 1e-9);
      ASSERT_NEAR(foot.normal.z(), side, 1e-9);
    });
    // Round the free edge and back: the other side is felt now.
    const auto quiet = [](const Foot&, const Vector3d&) {};
    hand.walk({0.05, 0.05, -0.02 * side}, {0.15, 0.05, -0.02 * side}, 1e-4, quiet);
    hand.walk({0.15, 0.05, -0.02 * side}, {0.05, 0.05, -0.02 * side}, 1e-4, quiet);
    hand.walk({0.05, 0.05, -0.02 * side}, {0.05, 0.05, 0.01 * side}, 1e-4,
              [&](const Foot& foot, const Vector3d& p) { ASSERT_NEAR(foot.depth, side * p.z(), 1e-9); });
    hand.tracer.popThrough();
    EXPECT_LT(hand.at({0.05, 0.05, 0.0101 * side}).depth, 0);
    EXPECT_NEAR(hand.at({0.05, 0.05, -0.001 * side}).depth, 0.001, 1e-9);
  }
}

/// In a solid thicker than the press, a held foot is the nearest one: the whole walk is the same without holding.
TEST(Held, InAThickSolidIsTheNearestPoint) {
  for (const char* name : {"sphere", "torus", "cylinder", "box"}) {
    const Model model = solid(name);
    Hand hand{model};
    std::mt19937 random(3);
    std::normal_distribution<double> turn(0, 0.15);
    Vector3d p(0, 0.055, 0), heading(1, 0, 0);
    if (std::string(name) == "torus") p = {0.05, 0.025, 0};
    int wrong = 0, held = 0;
    for (int tick = 0; tick < 20000; ++tick) {
      const double distance = signedDistance(name, p);
      const Foot foot = hand.at(p);
      const bool other = std::abs(-foot.depth - distance) > 1e-6, says_so = foot.status == FootStatus::kHeld;
      wrong += other && !says_so ? 1 : 0;
      held += other && says_so ? 1 : 0;
      const double goal = 0.0005 * std::sin(1e-3 * tick);
      Vector3d turned;  // one number after another, since compilers order the arguments of a call differently
      for (double& one : turned) one = turn(random);
      heading += turned - 0.5 * std::clamp((distance - goal) / 0.0005, -1.0, 1.0) * foot.normal;
      heading.normalize();
      p += 1e-4 * heading;
    }
    EXPECT_EQ(wrong, 0) << name;
    EXPECT_LE(held, 1000) << name;  // near sharp edges of the box and the cylinder; compilers make other walks
  }
}

/// A valley of two planes, with three coinciding rows of control points. One weight is no multiple of the others, so
/// the spans stay as they are: their tangent vanishes at the rows, and a step of Newton's method may end at that very
/// place.
TEST(Held, AFootAtACuspIsANumber) {
  spline::SurfaceData data;
  data.degree = {3, 1};
  data.knots = {{{0, 0, 0, 0, 0.5, 1, 1, 1, 1}, {0, 0, 1, 1}}};
  for (const double x : {-0.03, 0.0, 0.0, 0.0, 0.03})
    for (const double y : {-0.03, 0.03}) data.points.emplace_back(x, y, std::abs(x));
  data.weights.assign(data.points.size(), 1.0);
  data.weights.front() = 1.5;
  const Model model({data});
  Hand hand{model};
  for (int tick = 0; tick < 12; ++tick) {
    const Foot foot = hand.at({-1.7144066653108014e-05, 0.002240123946138025, -0.0017811736213684706});
    EXPECT_TRUE(foot.point.allFinite() && foot.normal.allFinite() && std::isfinite(foot.depth)) << tick;
  }
}

}  // namespace
}  // namespace hapticd::trace
