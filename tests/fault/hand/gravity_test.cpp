// SPDX-License-Identifier: MIT
/// The torque that carries the arm's own weight is a force like any other: bounded, ramped, and off where no force may
/// be.
#include "scenario.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

/// An arm that says that it weighs so many newtons, in a scene with nothing within reach.
std::vector<Sent> carry(double newtons, const std::function<void(scene::Limits&)>& limit, double seconds = 0.4) {
  Scenario scenario({.models = {hostile("still")}, .limit = limit});
  scenario.wishes().weight[1] = newtons;
  return scenario.run(seconds);
}

TEST(Weight, IsRampedInLikeEveryForce) {
  const auto sent = carry(6, [](scene::Limits& limits) { limits.ramp_in = 0.1; });
  EXPECT_LE(sent.front().force.norm(), 6 * 0.011) << "in the first command";
  EXPECT_LE(largestTurn(sent), 6 * 0.011) << "and in each after it";
  EXPECT_NEAR(sent.back().force.y(), 6, 1e-9) << "an arm is carried in the end";
}

TEST(Weight, IsNeverMoreThanTheForceLimit) {
  for (const double newtons : {0.4, 6.0, 1e3, 1e300, -1e300}) {
    const auto sent = carry(newtons, [](scene::Limits& limits) { limits.force = 0.5; });
    EXPECT_LE(largest(sent), 0.5 * (1 + 1e-9)) << newtons;
    EXPECT_NEAR(sent.back().force.norm(), std::min(0.5, std::abs(newtons)), 1e-9) << newtons;
  }
}

TEST(Weight, OfNumbersThatOverflowLeavesNothing) {
  Scenario scenario({.models = {hostile("still")}, .limit = [](scene::Limits& limits) { limits.force = 0.5; }});
  for (double& newtons : scenario.wishes().weight) newtons = 1e300;
  const auto sent = scenario.run(0.2);
  for (const Sent& s : sent) ASSERT_TRUE(s.force.allFinite());
  EXPECT_LE(largest(sent), 0.5 * (1 + 1e-9));
}

TEST(Weight, FadesWithTheForceAfterAFault) {
  Scenario scenario({.models = {hostile("still")}});
  scenario.wishes().weight[1] = 3;
  const auto sent = scenario.run(0.5, [&](double t) {
    if (t >= 0.2) scenario.wishes().faults = rig::kHardwareFault;
    return Nanoseconds{0};
  });
  double last = HUGE_VAL;
  for (const Sent& s : sent) {
    if (s.t < 0.1995) continue;
    EXPECT_LE(s.force.norm(), last) << s.t;
    if (s.t > 0.1995 && s.t < 0.2005) {
      EXPECT_GT(s.force.norm(), 0) << "in a ramp, at " << s.t;
    }
    if (s.t > 0.2025) {
      EXPECT_EQ(s.force.norm(), 0) << s.t;
    }
    last = s.force.norm();
  }
}

TEST(Weight, IsOffWhileTheEnableSwitchIs) {
  const auto sent = carry(3, [](scene::Limits& limits) { limits.enable = {0, scene::EnableMode::kHold}; });
  EXPECT_EQ(largest(sent), 0);
}

TEST(Weight, IsOffWhereItsLimitIsZero) {
  EXPECT_EQ(largest(carry(3, [](scene::Limits& limits) { limits.weight = 0; })), 0);
}

/// "Signs, without a force": the step of a new arm in which the signs of its motors are not known yet.
TEST(Weight, IsOffInAnEmptyScene) {
  Scenario scenario({});
  scenario.wishes().weight[1] = 3;
  EXPECT_EQ(largest(scenario.run(0.4)), 0);
}

/// Joint torques and tip forces of an arm whose joints are no axes of the tip, near a singular pose too.
TEST(Weight, IsBoundedAtTheTipWhateverThePose) {
  std::srand(1);
  for (int i = 0; i < 20000; ++i) {
    TipJacobian J = TipJacobian::Random(3, 3 + i % 5) * 0.3;
    if (i % 3 == 0) J.col(2) = J.col(1) * (1 + 1e-6 * (i % 7));
    Weight::Torques torques{};
    for (Eigen::Index k = 0; k < J.cols(); ++k)
      torques[static_cast<size_t>(k)] = 10 * (2.0 * std::rand() / RAND_MAX - 1);
    const double share = shareWithin(2, torques, J);
    ASSERT_GT(share, 0);
    ASSERT_LE(share, 1);
    const JointVector left = share * Eigen::Map<const Eigen::VectorXd>(torques.data(), J.cols());
    ASSERT_LE(TipInverse(J).force(left).norm(), 2 * (1 + 1e-9));
    double lever = 0;
    for (Eigen::Index k = 0; k < J.cols(); ++k) lever = std::max(lever, J.col(k).norm());
    ASSERT_LE(left.cwiseAbs().maxCoeff(), 2 * lever * (1 + 1e-9));
  }
}

}  // namespace
}  // namespace hapticd::servo
