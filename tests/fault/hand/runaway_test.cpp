// SPDX-License-Identifier: MIT
/// A body that a plugin moves by itself: one that comes against the hand pushes ever more, until the host silences it.
#include "scenario.hpp"
#include "session/messages/silence_reason.hpp"
#include "shipped.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

scene::Model plate(bool comes) {
  return hostile("yielding", {value(0, HSP_BOOL, comes ? 1 : 0)});
}

/// A hand that goes down onto the plate and stays there. @param speed [m/s] @param depth [m]
std::vector<Sent> press(Scenario& scenario, double speed, double depth) {
  return scenario.run(1, [&scenario, speed, depth](double t) {
    scenario.moveTo(Vector3d(0, 0.01 - std::min(0.01 + depth, speed * t), 0));
    return Nanoseconds{0};
  });
}

TEST(ABodyThatRunsAway, IsSilencedAtEveryRate) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    Scenario scenario({.rate = rate, .models = {plate(true)}});
    const std::vector<Sent> sent = press(scenario, 0.1, 0.005);
    EXPECT_EQ(scenario.trouble(), ShapeFault::kRunsAway) << rate;
    double last = 0, strongest = 0;  // [s] of the last force; [N]
    for (const Sent& s : sent) {
      if (s.force.norm() > 0) last = s.t;
      strongest = std::max(strongest, s.force.norm());
    }
    EXPECT_GT(strongest, 1) << "nothing was tried: no test";
    EXPECT_LT(last, 0.5) << "the hand is pushed no more";
    EXPECT_NE(silenceReason(scenario.core().models()[0]).find("it runs away"), std::string::npos);
  }
}

TEST(ABodyThatGivesWay, IsFeltHoweverFastAHandStrikesIt) {
  for (const double speed : {0.1, 1.0, 5.0}) {
    Scenario scenario({.models = {plate(false)}});
    const std::vector<Sent> sent = press(scenario, speed, 0.005);
    EXPECT_EQ(scenario.trouble(), ShapeFault::kNone) << speed;
    // spring and wall in series
    EXPECT_NEAR(sent.back().force.norm(), 0.005 / (1 / 500.0 + 1 / 50.0), 0.02) << speed;
  }
}

TEST(AWheel, ThatTurnsPastAHandIsFeltAtEverySpeed) {
  for (const char* rate : {"100", "500", "2000"}) {  // [rad/s] the last is 100 m/s at the rim
    Scenario scenario({.models = shipped(std::string("  - name: wheel\n    plugin: nurbs_rigid\n    motion: dynamic\n"
                                                     "    parameters: {geometry: HERE/models/sphere.yaml, stiffness: "
                                                     "800, gravity: false, joint: hinge, axis: [0, 0, 1], spin: [0, "
                                                     "0, ") +
                                         rate + "]}\n")});
    const std::vector<Sent> sent = scenario.run(1, [&scenario](double t) {
      scenario.moveTo(Vector3d(0, std::max(0.045, 0.06 - 0.1 * t), 0));
      return Nanoseconds{0};
    });
    EXPECT_EQ(scenario.trouble(), ShapeFault::kNone) << rate;
    EXPECT_NEAR(sent.back().force.y(), 800 * 0.005, 0.1) << rate;
  }
}

}  // namespace
}  // namespace hapticd::servo
