// SPDX-License-Identifier: MIT
/// A plugin's force is compared, as a vector in the world, with what the probe's motion and the plugin's own claims
/// explain; traced or not, claimed or not.
#include <cmath>

#include "scenario.hpp"
#include "session/silence_reason.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

enum How { kTurns, kVibrates, kSteps, kTracedTurns, kHides, kSpins, kStretches };

scene::Model kicking(How how, double size, double jump = 0) {
  return hostile("kicking",
                 {value(0, HSP_ENUM, how), value(1, HSP_INT, 100), value(2, HSP_REAL, size), value(3, HSP_REAL, jump)});
}

/// No slew: what is held back is held back by the guard.
void bare(scene::Limits& limits) {
  limits.slew = 0;
}

struct Kicked {
  explicit Kicked(const scene::Model& model, double seconds = 0.6)
      : scenario({.models = {model}, .limit = bare}), sent(scenario.run(seconds)) {}
  Scenario scenario;
  std::vector<Sent> sent;
};

class Kick : public testing::TestWithParam<How> {};

/// 8 N that turn round each tick, 15 N peak to peak at 50 Hz, a step out of nothing, a pose that spins.
TEST_P(Kick, IsHeldBackAndThenSilenced) {
  Kicked kicked(kicking(GetParam(), GetParam() == kVibrates ? 7.5 : 8));
  EXPECT_GT(largest(kicked.sent), 0) << "nothing was tried: no test";
  // The tip is 2 mm from the origin about which the model spins.
  const double turned = GetParam() == kSpins ? Claim::kMargin * Claim::kUnclaimed * Claim::kOwnTurn * 1e-3 * 2e-3 : 0;
  EXPECT_LE(largest(kicked.sent), Claim::kStep + turned + 0.02 * Claim::kDrift) << "what a click may be, and a drift";
  for (const Sent& sent : kicked.sent)
    if (sent.t > 0.2) {
      ASSERT_EQ(sent.force.norm(), 0) << sent.t;
    }
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.trouble(), Trouble::kJump);
}
std::string nameOfHow(const testing::TestParamInfo<How>& given) {
  static constexpr const char* kNames[] = {"Turns", "Vibrates", "Steps", "TracedTurns", "Hides", "Spins"};
  return kNames[given.param];
}
INSTANTIATE_TEST_SUITE_P(Each, Kick, testing::Values(kTurns, kVibrates, kSteps, kSpins), nameOfHow);

/// A foot may go over an edge, and a surface may be found anew: three times, and no more.
class KickOfASurface : public testing::TestWithParam<How> {};
TEST_P(KickOfASurface, IsSilencedThoughItsNormalTurnsToo) {
  Kicked kicked(kicking(GetParam(), 8));
  int felt = 0;
  for (const Sent& sent : kicked.sent) {
    felt += sent.force.norm() > Claim::kStep + 0.5 ? 1 : 0;
    if (sent.t > 0.2) {
      ASSERT_EQ(sent.force.norm(), 0) << sent.t;
    }
  }
  EXPECT_LE(felt, static_cast<int>(Claim::kPasses) + 1);
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.trouble(), Trouble::kJump);
}
INSTANTIATE_TEST_SUITE_P(Each, KickOfASurface, testing::Values(kTracedTurns, kHides), nameOfHow);

TEST(KickOnPurpose, IsFeltAsFarAsItIsReported) {
  Kicked kicked(kicking(kVibrates, 3, 3));
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.trouble(), Trouble::kNone);
  double most = 0;
  for (const Sent& sent : kicked.sent) most = std::max(most, sent.t > 0.4 ? sent.force.norm() : 0);
  EXPECT_GT(most, 2.9);
}

TEST(KickOnPurpose, IsBoundedByTheReport) {
  Kicked kicked(kicking(kVibrates, 8, 3));
  EXPECT_LE(largest(kicked.sent), 3 + 0.02 * Claim::kDrift);
  EXPECT_EQ(kicked.sent.back().force.norm(), 0);
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.trouble(), Trouble::kJump);
}

/// 1 mN became 8.5 N.
TEST(PoseThatStretches, IsRefusedAndNamed) {
  Kicked kicked(kicking(kStretches, 0), 0.3);
  EXPECT_EQ(largest(kicked.sent), 0);
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.trouble(), Trouble::kNotUnit);
}

/// Presses to a depth of 5 mm and stays there.
std::vector<Sent> press(Scenario& scenario) {
  return scenario.run(0.4, [&](double t) {
    scenario.moveTo(Vector3d(0, 0.01 - std::min(0.015, 0.1 * t), 0));
    return Nanoseconds{0};
  });
}

TEST(SurfaceThatOnlyPushes, IsSilencedAndNamedWhenItPulls) {
  Scenario scenario({.models = {hostile("pulling", {value(1, HSP_BOOL, 1)})}, .limit = bare});
  EXPECT_LE(largest(press(scenario)), 0.1) << "found with the first newton";
  EXPECT_EQ(scenario.trouble(), Trouble::kPulls);
  const Pull& pull = scenario.core().models()[0].pull;
  EXPECT_NEAR(pull.t, 0.101, 1e-9) << "the first tick inside: 0.1 m/s, from 10 mm above";
  EXPECT_NEAR(pull.depth, 1e-4, 1e-9);
  EXPECT_NEAR(pull.force, 800 * 1e-4, 1e-6);
  const std::string why = silenceReason(scenario.core().models()[0]);
  EXPECT_NE(why.find("into its surface, at 0.101 s with 0.08 N at a depth of 0.1 mm: its force has the wrong sign"),
            std::string::npos)
      << why;
}

TEST(SurfaceThatOnlyPushes, IsAClaimThatNobodyMustMake) {
  Scenario scenario({.models = {hostile("pulling", {value(1, HSP_BOOL, 0)})}, .limit = bare});
  EXPECT_GT(largest(press(scenario)), 3);
  EXPECT_EQ(scenario.trouble(), Trouble::kNone);
}

/// A shape that forgets HSP_OUT_TRACED is felt, and the report must not say that nothing was touched.
TEST(ForceWithoutASurface, IsCountedAndSaid) {
  Scenario scenario({.models = {hostile("failing", {value(1, HSP_INT, 1000)}), hostile("still")}, .limit = bare});
  scenario.run(0.3);
  const record::RunReport report = scenario.telemetry().report({});
  EXPECT_GT(report.models[0].contact.untracedTicks(), 250u);
  EXPECT_DOUBLE_EQ(report.models[0].contact.maxUntraced(), 8);
  EXPECT_EQ(report.models[1].contact.untracedTicks(), 0u);
}

/// What a silenced model fades out with is not its answer.
TEST(ForceWithoutASurface, IsNotCountedWhileAModelFadesOut) {
  Scenario scenario({.models = {hostile("pulling", {value(1, HSP_BOOL, 1)})}, .limit = bare});
  press(scenario);
  EXPECT_EQ(scenario.telemetry().report({}).models[0].contact.untracedTicks(), 0u);
}

}  // namespace
}  // namespace hapticd::servo
