// SPDX-License-Identifier: MIT
/// What the samples of an arm may do to the force: jumps, pairs, stamps, silence, orientations.
#include <cmath>

#include "scenario.hpp"
#include "shipped.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

const char* const kBox =
    "  - name: box\n    plugin: nurbs_rigid\n    parameters: {geometry: HERE/models/box.yaml, stiffness: 1000}\n";

/// Rests 4 mm deep in the top of a box, then jumps deeper by `way`.
struct Jumping {
  Jumping(
      double rate, double way, const std::function<void(scene::Limits&)>& limit = [](scene::Limits&) {})
      : scenario({.rate = rate, .models = shipped(kBox), .limit = limit}) {
    sent = scenario.run(0.3, [&](double t) {
      scenario.moveTo({0, 0.046 - (t >= 0.2 ? way : 0), 0});
      fault = t < 0.295 ? scenario.fault() : fault;
      measured = scenario.arm().limiter().measured();
      return Nanoseconds{0};
    });
  }
  Fault fault = Fault::kNone;
  double measured = 0;
  Scenario scenario;
  std::vector<Sent> sent;
};

/// Before its first report an arm says of no button that it is up.
TEST(EnableSwitch, IsNotLetGoByAnArmThatHasReportedNothing) {
  Scenario scenario({.models = {hostile("failing", {value(1, HSP_INT, 100000)})},
                     .limit = [](scene::Limits& limits) { limits.enable = {0, scene::EnableMode::kHold}; }});
  bool found = false;
  const auto sent = scenario.run(0.4, [&](double t) {
    scenario.wishes().faults = t < 0.0095 ? rig::kSilent : 0u;
    scenario.wishes().buttons = t < 0.0095 || (t > 0.2 && t < 0.21) ? 0 : 1;
    if (t > 0.1 && t < 0.2) found |= scenario.arm().foundPressed();
    return Nanoseconds{0};
  });
  EXPECT_TRUE(found) << "and a person is told";
  for (const Sent& s : sent) {
    if (s.t < 0.2) {
      EXPECT_EQ(s.force.norm(), 0) << s.t;
    }
  }
  EXPECT_GT(sent.back().force.norm(), 3) << "let go and pressed";
}

/// It was 8.5 N, and no fault.
TEST(EncoderJump, OfThirtyNineMillimetresInATenthOfAMillisecondEndsTheForce) {
  const Jumping jumping(10000, 0.039);
  EXPECT_EQ(jumping.fault, Fault::kTooFast);
  double before = 0;
  for (const Sent& sent : jumping.sent) {
    if (sent.t > 0.15 && sent.t < 0.19995) {
      EXPECT_NEAR(sent.force.norm(), 4, 0.2) << sent.t;
    }
    if (sent.t > 0.19995) {
      EXPECT_LE(sent.force.norm(), before) << sent.t;
    }
    if (sent.t > 0.2023) {
      EXPECT_EQ(sent.force.norm(), 0) << sent.t;
    }
    before = sent.force.norm();
  }
}

class EncoderJumpOf : public testing::TestWithParam<double> {};

/// Whatever is faster than 5 m/s by the samples' own times.
TEST_P(EncoderJumpOf, SoManyMillimetresInAMillisecondIsAFault) {
  const double way = GetParam() * 1e-3;
  const Jumping jumping(1000, way);
  EXPECT_EQ(jumping.fault, way > 0.04 ? Fault::kJumped : way > 0.005 ? Fault::kTooFast : Fault::kNone);
  if (way > 0.005 && way < 0.04) {
    EXPECT_NEAR(jumping.measured, way / 1e-3, 1e-6);
  }
}
INSTANTIATE_TEST_SUITE_P(Millimetres, EncoderJumpOf, testing::Values(4.9, 5.2, 12, 39, 60));

TEST(EncoderJump, MayBeAsFarAsTheDeviceFileSays) {
  const Jumping fast(1000, 0.012, [](scene::Limits& limits) { limits.velocity = 15; });
  EXPECT_EQ(fast.fault, Fault::kNone);
  const Jumping any(1000, 0.03, [](scene::Limits& limits) { limits.velocity = 0; });
  EXPECT_EQ(any.fault, Fault::kNone);
}

/// A hand of 3 m/s, whose samples are measured each ms and come two at a time.
TEST(Pairs, AreNoJumps) {
  Scenario scenario({.rate = 2000, .models = {hostile("still")}});
  Fault fault = Fault::kNone;
  scenario.run(0.3, [&](double t) {
    const long tick = std::lround(t * 2000), first = tick / 4 * 4, half = tick % 4;
    scenario.moveTo({0, 3.0 * static_cast<double>(first + (half == 0 ? 0 : 2)) / 2000 - 0.4, 0});
    scenario.wishes().stamp_ns = static_cast<uint64_t>(first) * 500'000 + (half == 0 ? 1 : 2);
    scenario.wishes().faults = half >= 2 ? static_cast<uint32_t>(rig::kSilent) : 0u;
    fault = t < 0.295 ? scenario.fault() : fault;
    return Nanoseconds{0};
  });
  EXPECT_EQ(fault, Fault::kNone);
}

/// The arm says nothing for 50 ms: the force of the last sample is not held for so long.
TEST(Silence, FadesTheForceLongBeforeItIsAFault) {
  Scenario scenario({.models = shipped(kBox)});
  Fault fault = Fault::kNone;
  const auto sent = scenario.run(0.3, [&](double t) {
    scenario.moveTo({0, 0.046, 0});
    scenario.wishes().faults = t >= 0.2 ? static_cast<uint32_t>(rig::kSilent) : 0u;
    fault = t < 0.295 ? scenario.fault() : fault;
    return Nanoseconds{0};
  });
  double impulse = 0;
  for (const Sent& s : sent) {
    if (s.t > 0.1995) impulse += s.force.norm() * 1e-3;
    if (s.t > 0.2035) {
      EXPECT_EQ(s.force.norm(), 0) << s.t;
    }
  }
  EXPECT_GT(impulse, 4 * 1.9e-3) << "one sample may be late";
  EXPECT_LE(impulse, 4 * 2.6e-3);
  EXPECT_EQ(fault, Fault::kStale);
}

TEST(Orientation, ThatIsNotOfUnitLengthIsAFaultOfTheDevice) {
  Scenario scenario({.models = shipped(kBox)});
  const auto sent = scenario.run(0.3, [&](double t) {
    scenario.moveTo({0, 0.046, 0});
    scenario.wishes().orientation[0] = t >= 0.2 ? 100 : 1;
    return Nanoseconds{0};
  });
  EXPECT_EQ(scenario.fault(), Fault::kNotUnit);
  EXPECT_EQ(scenario.arm().limiter().measured(), 100);
  for (const Sent& s : sent)
    if (s.t > 0.2025) {
      EXPECT_EQ(s.force.norm(), 0) << s.t;
    }
}

}  // namespace
}  // namespace hapticd::servo
