// SPDX-License-Identifier: MIT
/// Forces in the middle of a sheet and round its rim: constant while the probe is still, without jumps while it moves.
#include <random>

#include "soft_plugin.hpp"

namespace hapticd::test {
namespace {

const Vector3d kPlace(.0123, -.031, 0);

TEST(MiddleOfASheet, AStillProbeFeelsAConstantForceAcrossIt) {
  for (const double side : {1., -1.}) {
    for (const double off : {0., 1e-12, 1e-10, 3e-10, 1e-9, 3e-9, 1e-8, 1e-7, 1e-6}) {
      Plugin plate;
      ASSERT_EQ(plate.activate(), HSP_OK);
      const Vector3d p = kPlace + Vector3d(0, 0, side * off);
      plate.search(p);
      const Vector3d first = forceOf(plate.touch(p));
      EXPECT_NEAR(std::fabs(first.z()), 6.72, .01) << off;
      EXPECT_LT(first.head<2>().norm(), 1e-6) << off;
      for (int i = 0; i < 200; ++i) ASSERT_LT((forceOf(plate.touch(p)) - first).norm(), 1e-6) << off << " " << i;
    }
  }
}

/// Follows a path and holds each change of force to what the way allows.
class Follower {
 public:
  explicit Follower(const Vector3d& start, const char* search = "newton") : last_(start) {
    plate_.set("search", std::strcmp(search, "binary") == 0 ? 1. : 0.);
    EXPECT_EQ(plate_.activate(), HSP_OK);
    plate_.search(start);
    before_ = forceOf(plate_.touch(start));
  }
  /// @param factor of the stiffness that the plate reports
  hsp_contact go(const Vector3d& p, double factor = 1) {
    const hsp_contact contact = plate_.touch(p);
    const Vector3d force = forceOf(contact), normal(contact.normal);
    EXPECT_LE((force - before_).norm(), factor * plate_.report.max_stiffness * (p - last_).norm() + 1e-6)
        << p.transpose() << ": " << before_.transpose() << " -> " << force.transpose();
    if (force.norm() > 0) {
      EXPECT_GT(force.dot(normal), .8 * force.norm()) << p.transpose();
    }
    before_ = force;
    last_ = p;
    return contact;
  }

 private:
  Plugin plate_;
  Vector3d last_, before_;
};

TEST(MiddleOfASheet, APressEndsOnItWithoutAJump) {
  Follower probe(kPlace + Vector3d(0, 0, .0101));
  for (int i = 200; i >= 0; --i) probe.go(kPlace + Vector3d(0, 0, 5e-5 * i));
  for (int i = 0; i < 50; ++i) EXPECT_GT(probe.go(kPlace).force[2], 6.7);
}

TEST(MiddleOfASheet, CountsOfAnEncoderCrossItWithoutAJump) {
  static constexpr double kCount = 29e-6;  // [m]
  const auto counted = [](const Vector3d& p) -> Vector3d { return (p / kCount).array().round() * kCount; };
  Follower probe(counted(kPlace + Vector3d(0, 0, .0101)));
  for (int i = 0; i < 380; ++i) {
    const Vector3d p = counted(kPlace + Vector3d(1e-6 * i, 0, .0101 - 5e-5 * i));
    EXPECT_GE(probe.go(p).force[2], 0);  // to the side that it came from
  }
}

TEST(RimOfASheet, AProbePressedThroughItIsStillPushedBack) {
  for (const Vector3d& at : {Vector3d(.05, 0, 0), Vector3d(.05, .04, 0), Vector3d(.0501, .003, 0)}) {
    Follower probe(at + Vector3d(0, 0, .0101));
    double before = 0;
    for (int i = 0; i < 390; ++i) {
      const double push = probe.go(at + Vector3d(0, 0, .0099 - 5e-5 * i)).force[2];
      EXPECT_GT(push, before) << at.transpose() << ", " << i;
      before = push;
    }
  }
}

TEST(RimOfASheet, TheBinarySearchFeelsItToo) {
  const Vector3d at(.0503, .003, 0);
  Follower probe(at + Vector3d(0, 0, .0101), "binary");
  for (int i = 0; i < 390; ++i) EXPECT_GT(probe.go(at + Vector3d(0, 0, .0098 - 5e-5 * i)).force[2], 0) << i;
}

TEST(RimOfASheet, NoiseThereChangesTheForceLittle) {
  for (const Vector3d& at : {Vector3d(.05, 0, 0), Vector3d(.05, .04, 0)}) {
    Follower probe(at + Vector3d(0, 0, .0101));
    for (int i = 202; i > 0; --i) probe.go(at + Vector3d(0, 0, 5e-5 * i));
    std::mt19937 engine(1);
    std::normal_distribution<double> noise(0, 3e-5);
    for (int i = 0; i < 5000; ++i) probe.go(at + Vector3d(noise(engine), noise(engine), noise(engine)), 5);
  }
}

TEST(RimOfASheet, RoundItAndBackTheForceIsThatOfThePlace) {
  Follower probe({0, 0, .009});
  Vector3d p(0, 0, .009);
  for (int i = 0; i < 1000; ++i) probe.go(p = {5e-5 * i, 0, .009});
  for (int i = 0; i <= 400; ++i)
    probe.go(p = {.05 + .009 * std::sin(M_PI * i / 400), 0, .009 * std::cos(M_PI * i / 400)});
  hsp_contact last{};
  for (int i = 0; i < 400; ++i) last = probe.go(p - Vector3d(5e-5 * i, 0, 0));
  p.x() -= 5e-5 * 399;
  Plugin fresh;
  ASSERT_EQ(fresh.activate(), HSP_OK);
  fresh.search(p);
  EXPECT_LT((forceOf(fresh.touch(p)) - forceOf(last)).norm(), 1e-6);
  EXPECT_LT(last.force[2], 0);
}

TEST(RimOfASheet, AProbePushedInEdgeOnComesToFeelTheSheet) {
  Follower probe({.061, 0, .0003});
  hsp_contact last{};
  for (int i = 0; i < 600; ++i) last = probe.go({.061 - 5e-5 * i, 0, .0003}, 5);
  EXPECT_GT(last.force[2], 6);
  EXPECT_LT(std::fabs(last.force[0]), 1e-6);
}

}  // namespace
}  // namespace hapticd::test
