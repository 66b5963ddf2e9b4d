// SPDX-License-Identifier: MIT
/// A plugin's force is compared, as a vector in the world, with what the probe's motion and the plugin's own claims
/// explain; traced or not, claimed or not.
#include <cmath>
#include <tuple>

#include "scenario.hpp"
#include "session/messages/silence_reason.hpp"

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
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.fault(), ShapeFault::kJump);
}
std::string nameOfHow(const testing::TestParamInfo<How>& given) {
  static constexpr const char* kNames[] = {"Turns", "Vibrates", "Steps", "TracedTurns", "Hides", "Spins"};
  return kNames[given.param];
}
INSTANTIATE_TEST_SUITE_P(Each, Kick, testing::Values(kTurns, kVibrates, kSteps, kSpins), nameOfHow);

/// The guard counts strikes in ticks and drift in seconds: neither may open a door at another rate. (Forces
/// are compared no further than the arm's limit. A slow arm has less, and what jumps by less than 2 N is no kick.)
class KickAtRate : public testing::TestWithParam<std::tuple<double, How>> {};
TEST_P(KickAtRate, IsHeldBackAndThenSilenced) {
  const auto [rate, how] = GetParam();
  Scenario scenario({.rate = rate, .models = {kicking(how, 8)}, .limit = bare, .full_when_slow = true});
  const double begins = 100 / rate;
  const std::vector<Sent> sent = scenario.run(begins + std::max(0.1, 20 / rate));
  EXPECT_GT(largest(sent), 0) << "nothing was tried: no test";
  EXPECT_LE(largest(sent), Claim::kStep + Claim::kDrift * (20e-3 + 4 / rate));
  for (const Sent& s : sent)
    if (s.t > begins + std::max(0.03, 10 / rate)) {
      ASSERT_EQ(s.force.norm(), 0) << s.t;
    }
  EXPECT_EQ(scenario.trouble(), ShapeFault::kJump);
}
INSTANTIATE_TEST_SUITE_P(Each, KickAtRate,
                         testing::Combine(testing::Values(100.0, 10000.0), testing::Values(kTurns, kSteps)));

/// A plugin that kicks beside one that pushes as it should: only the first is silenced, whichever comes first.
TEST(KickBesideAnother, SilencesTheCulpritAlone) {
  for (const uint32_t culprit : {0u, 1u}) {
    std::vector<scene::Model> models(2, hostile("failing", {value(1, HSP_INT, 1000000)}));
    models[culprit] = kicking(kTurns, 8);
    Scenario scenario({.models = models, .limit = bare});
    const std::vector<Sent> sent = scenario.run(0.6);
    EXPECT_EQ(scenario.trouble(culprit), ShapeFault::kJump);
    EXPECT_EQ(scenario.trouble(1 - culprit), ShapeFault::kNone);
    EXPECT_NEAR(sent.back().force.norm(), 8, 1e-9) << "the other one is felt as before";
  }
}

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
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.fault(), ShapeFault::kJump);
}
INSTANTIATE_TEST_SUITE_P(Each, KickOfASurface, testing::Values(kTracedTurns, kHides), nameOfHow);

TEST(KickOnPurpose, IsFeltAsFarAsItIsReported) {
  Kicked kicked(kicking(kVibrates, 3, 3));
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.fault(), ShapeFault::kNone);
  double most = 0;
  for (const Sent& sent : kicked.sent) most = std::max(most, sent.t > 0.4 ? sent.force.norm() : 0);
  EXPECT_GT(most, 2.9);
}

TEST(KickOnPurpose, IsBoundedByTheReport) {
  Kicked kicked(kicking(kVibrates, 8, 3));
  EXPECT_LE(largest(kicked.sent), 3 + 0.02 * Claim::kDrift);
  EXPECT_EQ(kicked.sent.back().force.norm(), 0);
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.fault(), ShapeFault::kJump);
}

/// A click that somebody wants must be told by how much it was too large, and what to report.
TEST(KickOnPurpose, ThatIsNotReportedIsToldWithItsSizeItsTimeAndTheCure) {
  Kicked kicked(kicking(kSteps, 8));
  const ModelState& model = kicked.scenario.core().models()[0];
  EXPECT_EQ(model.guard.fault(), ShapeFault::kJump);
  EXPECT_NEAR(model.breach.force, 8, 1e-9) << "out of nothing";
  EXPECT_NEAR(model.breach.t, 0.1, 2e-3) << "after a hundred ticks of peace";
  const std::string why = silenceReason(model);
  EXPECT_NE(why.find("; the largest jump was 8 N at 0.1"), std::string::npos) << why;
  EXPECT_NE(why.find("if on purpose, call reportJumps(report, 8)"), std::string::npos) << why;
  Kicked reported(kicking(kSteps, 8, 8));
  EXPECT_EQ(reported.scenario.core().models()[0].guard.fault(), ShapeFault::kNone) << "the cure holds";
}

/// 1 mN became 8.5 N.
TEST(PoseThatStretches, IsRefusedAndNamed) {
  Kicked kicked(kicking(kStretches, 0), 0.3);
  EXPECT_EQ(largest(kicked.sent), 0);
  EXPECT_EQ(kicked.scenario.core().models()[0].guard.fault(), ShapeFault::kNotUnit);
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
  EXPECT_EQ(scenario.trouble(), ShapeFault::kPulls);
  const Breach& pull = scenario.core().models()[0].breach;
  EXPECT_NEAR(pull.t, 0.101, 1e-9) << "the first tick inside: 0.1 m/s, from 10 mm above";
  EXPECT_NEAR(pull.depth, 1e-4, 1e-9);
  EXPECT_NEAR(pull.force, 800 * 1e-4, 1e-6);
  const std::string why = silenceReason(scenario.core().models()[0]);
  EXPECT_NE(why.find("into its surface, at 0.101 s with 0.08 N at a depth of 0.1 mm: its force has the wrong sign"),
            std::string::npos)
      << why;
}

/// A force toward a surface that is told at no depth is a pull from outside; what was forgotten is named too.
TEST(SurfaceThatOnlyPushes, IsToldThatItsDepthWasLeftAtZero) {
  Scenario scenario({.models = {hostile("pulling", {value(2, HSP_BOOL, 1)})}, .limit = bare});
  press(scenario);
  EXPECT_EQ(scenario.trouble(), ShapeFault::kPulls);
  const std::string why = silenceReason(scenario.core().models()[0]);
  EXPECT_NE(why.find("at a depth of 0 mm: its depth_m was left at 0 inside, or its force has the wrong sign"),
            std::string::npos)
      << why;
  Scenario claimless({.models = {hostile("pulling", {value(1, HSP_BOOL, 0), value(2, HSP_BOOL, 1)})}, .limit = bare});
  press(claimless);
  EXPECT_EQ(claimless.trouble(), ShapeFault::kNone);
  EXPECT_GT(claimless.telemetry().report({}).models[0].contact.depthless().ticks, 10u);
}

TEST(SurfaceThatOnlyPushes, IsAClaimThatNobodyMustMake) {
  Scenario scenario({.models = {hostile("pulling", {value(1, HSP_BOOL, 0)})}, .limit = bare});
  EXPECT_GT(largest(press(scenario)), 3);
  EXPECT_EQ(scenario.trouble(), ShapeFault::kNone);
  const record::ContactStatistics contact = scenario.telemetry().report({}).models[0].contact;
  EXPECT_GT(2 * contact.pulls().ticks, contact.contactTicks()) << "but the report tells of its pull";
  EXPECT_GT(contact.pulls().max_force, 3);
}

/// A shape that forgets HSP_OUT_TRACED is felt, and the report must not say that nothing was touched.
TEST(ForceWithoutASurface, IsCountedAndSaid) {
  Scenario scenario({.models = {hostile("failing", {value(1, HSP_INT, 1000)}), hostile("still")}, .limit = bare});
  scenario.run(0.3);
  const record::RunReport report = scenario.telemetry().report({});
  EXPECT_GT(report.models[0].contact.untraced().ticks, 250u);
  EXPECT_DOUBLE_EQ(report.models[0].contact.untraced().max_force, 8);
  EXPECT_EQ(report.models[1].contact.untraced().ticks, 0u);
}

/// So is one that tells its surface, and leaves its depth at 0; a push from outside is told apart.
TEST(ForceWithoutADepth, IsCountedAndSaid) {
  for (const double depth : {0.0, -1e-3, 1e-3}) {
    Scenario scenario({.models = {hostile("shallow", {value(0, HSP_REAL, depth)}), hostile("still")}, .limit = bare});
    scenario.run(0.3);
    const record::ContactStatistics contact = scenario.telemetry().report({}).models[0].contact;
    EXPECT_EQ(contact.depthless().ticks > 250, depth == 0) << depth;
    EXPECT_EQ(contact.outside().ticks > 250, depth < 0) << depth;
    EXPECT_EQ(contact.contactTicks() > 250, depth > 0) << depth;
    EXPECT_EQ(contact.depthless().ticks + contact.outside().ticks > 0, depth <= 0) << depth;
    EXPECT_DOUBLE_EQ(contact.depthless().max_force, depth == 0 ? 1.5 : 0);
    EXPECT_EQ(contact.untraced().ticks, 0u);
  }
}

/// What a silenced model fades out with is not its answer.
TEST(ForceWithoutASurface, IsNotCountedWhileAModelFadesOut) {
  Scenario scenario({.models = {hostile("pulling", {value(1, HSP_BOOL, 1)})}, .limit = bare});
  press(scenario);
  EXPECT_EQ(scenario.telemetry().report({}).models[0].contact.untraced().ticks, 0u);
}

/// A hand that is thrown to and fro: its way explains the change of the force, and the force gives it energy each time.
TEST(ASurfaceThatTurnsRound, IsSilencedAlthoughTheHandGoesAlong) {
  for (const int every : {10, 20, 40, 60}) {
    scene::Model model = kicking(kTracedTurns, 8);
    model.parameters.push_back(value(4, HSP_INT, every));
    Scenario scenario({.models = {model}, .limit = bare});
    double y = 0;
    const std::vector<Sent> sent = scenario.run(2, [&](double t) {
      y += t < 0.1 ? 0 : 1e-3 * (static_cast<int>(std::lround(1e3 * t) - 100) / every % 2 == 0 ? 1 : -1);  // 1 m/s
      scenario.moveTo({0, y, 0});
      return Nanoseconds{0};
    });
    EXPECT_EQ(scenario.trouble(), ShapeFault::kGives) << every;
    EXPECT_EQ(sent.back().force.norm(), 0) << every;
    EXPECT_NE(silenceReason(scenario.core().models()[0]).find("energy from nowhere"), std::string::npos);
  }
}

/// Neither without a surface, nor with a jump that is reported, nor with a parameter that is set in each tick.
TEST(AForceThatGoesAlongWithTheHand, IsSilencedWhateverTheShapeSaysOfItself) {
  const struct {
    How how;
    double jump;
    bool sets;
  } kCases[] = {{kTurns, 0, false}, {kTracedTurns, 8, false}, {kTracedTurns, 0, true}};
  for (const auto& [how, jump, sets] : kCases) {
    scene::Model model = kicking(how, 8, jump);
    model.parameters.push_back(value(4, HSP_INT, 60));
    Scenario scenario({.models = {model}, .limit = bare});
    double y = 0, given = 0;
    scenario.run(3, [&](double t) {
      const double way = t < 0.1 ? 0 : std::lround(1e3 * t - 100) / 60 % 2 == 0 ? 1e-3 : -1e-3;
      scenario.moveTo({0, y += way, 0});
      given += scenario.arm().force().y() * way;
      if (sets) scenario.core().apply({.kind = Order::Kind::kSet, .target = 0, .param = 2, .value = 8}, t);
      return Nanoseconds{0};
    });
    EXPECT_EQ(scenario.trouble(), ShapeFault::kGives) << how << " " << jump << " " << sets;
    EXPECT_LT(given, 1.5 * 8.5 * EnergyAccount::kDistance) << how << " " << jump << " " << sets;
    EXPECT_GT(given, 1) << "nothing was tried: no test";
  }
}

}  // namespace
}  // namespace hapticd::servo
