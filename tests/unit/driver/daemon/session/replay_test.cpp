// SPDX-License-Identifier: MIT
#include "session/replay/replay.hpp"

#include <nlohmann/json.hpp>
#include <random>

#include "session/run/watched_servo.hpp"
#include "test_rig.hpp"
#include "watch/watchdog.hpp"

namespace hapticd::servo {
namespace {

void quiet(int, const std::string&, const std::string&) {}

/// A rig whose loop is recorded from its first tick.
struct Recorded : Rig {
  static constexpr uint64_t kTicks = 200;

  Recorded(const char* shape, std::vector<scene::Value> values, const std::vector<scene::Value>& device = {},
           const std::vector<scene::Model>& more = {}, const scene::Clients& clients = {},
           const scene::Enable& enable = {})
      : Rig(
            0, [this](Nanoseconds now) { return every(now), Nanoseconds{0}; }, kTicks, shape, std::move(values), more,
            device,
            [&](scene::Limits& limits) {
              limits.force = clients.mode != scene::ClientMode::kOff ? 5 : 0;
              limits.enable = enable;
            },
            clients) {}
  std::function<void(Nanoseconds)> every = [](Nanoseconds) {};  ///< before each tick

  /// Every step takes longer than it may.
  void starve() {
    scene.servo.budget_us = 1e-3;
    WorldOptions options;
    options.measure = options.budgets = true;
    world = std::move(*World::build(scene, options, quiet));
    loop = std::make_unique<Loop>(world->core(), world->lockstep(), arms, clock, settings, *telemetry);
  }

  /// As in versions in which a hold button that was down before the run enabled.
  void enableByFoundPressed() {
    found_pressed = true;
    arms[0] = std::move(*Arm::open(scene.devices[0], scene.servo, {1000, false, nullptr, {}, true}, quiet));
    ASSERT_TRUE(arms[0]->start(0, Eigen::Vector3d(0, -9.81, 0)));
  }

  /// As in versions in which a steady push of a program counted as energy from nothing.
  void pushByTheFormerLaw() {
    former_passivity = true;
    arms[0] = std::move(
        *Arm::open(scene.devices[0], scene.servo, {1000, false, nullptr, scene.clients, false, false, true}, quiet));
    ASSERT_TRUE(arms[0]->start(0, Eigen::Vector3d(0, -9.81, 0)));
  }

  /// As in versions in which neither torques nor steps after a set were held to a claim.
  void holdToFormerClaims() {
    former_claims = true;
    WorldOptions options;
    options.former_claims = true;
    world = std::move(*World::build(scene, options, quiet));
    loop = std::make_unique<Loop>(world->core(), world->lockstep(), arms, clock, settings, *telemetry);
  }

  /// A loop of 100 Hz. @param full the arm pushes with all of its force, as in versions before slow ones pushed less
  void slowDown(bool full) {
    rate = 100;
    full_when_slow = full;
    settings.period_ns = 10'000'000;
    arms[0] = std::move(*Arm::open(scene.devices[0], scene.servo, {rate, false, nullptr, {}, false, full}, quiet));
    ASSERT_TRUE(arms[0]->start(0, Eigen::Vector3d(0, -9.81, 0)));
    loop = std::make_unique<Loop>(world->core(), world->lockstep(), arms, clock, settings, *telemetry);
  }

  void record() {
    const auto streams = flightStreams(scene, arms, rate, 1000 / rate, 0);
    const RunFacts facts{rate,          settings.period_ns, settings.ticks,   true,          found_pressed,
                         former_claims, full_when_slow,     former_passivity, counts_unfelt, false};
    about = aboutRun(scene, *world, arms, facts, streams);
    auto flight = std::make_unique<Flight>(std::move(*record::FlightRing::create(streams, about)), arms, 8);
    if (counts_unfelt) flight->countUnfelt();
    telemetry->attach(std::move(flight));
    loop->run();
  }

  ReplayOutcome replay() {
    const record::FlightRing& ring = telemetry->flight()->ring();
    auto recording = record::Recording::parse({ring.image(), ring.imageBytes()}, "memory");
    EXPECT_TRUE(recording) << (recording ? "" : recording.error());
    auto run = readAbout(about.json);
    EXPECT_TRUE(run) << (run ? "" : run.error());
    auto replay = Replay::prepare(**recording, std::move(*run), quiet);
    EXPECT_TRUE(replay) << (replay ? "" : replay.error());
    return (*replay)->run();
  }

  record::About about;
  double rate = 1000;
  bool found_pressed = false, former_claims = false, full_when_slow = false, former_passivity = false;
  bool counts_unfelt = false;
};

void expectSame(const ReplayOutcome& outcome) {
  EXPECT_EQ(outcome.ticks, Recorded::kTicks) << outcome.note;
  ASSERT_FALSE(outcome.first) << outcome.first->what << " in tick " << outcome.first->tick << ": "
                              << outcome.first->recorded << ", now " << outcome.first->replayed;
}

TEST(Replay, IsTheSameToTheLastBit) {
  Recorded rig("wall", {});
  rig.record();
  expectSame(rig.replay());
}

#ifndef HAPTICD_SANITIZED  // the watchdog counts processor time, which the sanitizers take too
TEST(Replay, IsTheSameWhereTheWatchdogCutTheMotors) {
  Recorded rig("deadly", {number(0, HSP_ENUM, 5)});
  WatchedServo watched(*rig.loop, rig.arms, *rig.telemetry);
  watch::Watchdog watchdog(watched, [] {});
  ASSERT_FALSE(watchdog.start(81));
  rig.record();
  watchdog.stop();
  ASSERT_EQ(rig.arms[0]->limiter().fault(), Fault::kStuck);
  expectSame(rig.replay());
}
#endif

TEST(Replay, IsTheSameWhereAShapeWasLoweredAndSilencedForItsTime) {
  Recorded rig("wall", {});
  rig.starve();
  rig.record();
  EXPECT_EQ(rig.world->core().models()[0].coarsest, Accuracy::kCoarsest);
  EXPECT_EQ(rig.world->core().models()[0].guard.fault(), ShapeFault::kOverrun);
  expectSame(rig.replay());
}

TEST(Replay, IsTheSameThroughEveryFailureOfTheDevice) {
  for (int failure = 1; failure <= 5; ++failure) {
    Recorded rig("wall", {}, {number(2, HSP_ENUM, failure), number(3, HSP_REAL, 0.1)});
    rig.record();
    EXPECT_NE(rig.arms[0]->limiter().fault(), Fault::kNone);
    expectSame(rig.replay());
  }
}

TEST(Replay, IsTheSameWhereAHoldButtonWasFoundPressed) {
  Recorded rig("wall", {}, {}, {}, {}, {0, scene::EnableMode::kHold});
  double most = 0;
  rig.every = [&](Nanoseconds) { most = std::max(most, rig.arms[0]->force().norm()); };
  rig.record();
  EXPECT_EQ(most, 0) << "the gantry's button is down from the beginning";
  EXPECT_TRUE(rig.arms[0]->foundPressed());
  expectSame(rig.replay());
}

/// A recording that says nothing of the rule was made before there was one.
TEST(Replay, LetsAButtonThatWasFoundPressedEnableAsItDidOnce) {
  Recorded rig("wall", {}, {}, {}, {}, {0, scene::EnableMode::kHold});
  rig.enableByFoundPressed();
  double most = 0;
  rig.every = [&](Nanoseconds) { most = std::max(most, rig.arms[0]->force().norm()); };
  rig.record();
  EXPECT_GT(most, 1);
  auto about = nlohmann::json::parse(rig.about.json);
  ASSERT_EQ(about.at("enable_released_first"), false);
  about.erase("enable_released_first");
  rig.about.json = about.dump();
  expectSame(rig.replay());
}

/// A recording that says nothing of the rule was made when a slow arm pushed with all of its force.
TEST(Replay, IsTheSameOnASlowArmUnderEitherLaw) {
  for (const bool full : {false, true}) {
    Recorded rig("wall", {number(0, HSP_REAL, 2000)}, {number(4, HSP_BOOL, 1)});
    rig.slowDown(full);
    double most = 0;
    rig.every = [&](Nanoseconds) { most = std::max(most, rig.arms[0]->force().norm()); };
    rig.record();
    EXPECT_EQ(most > 2, full) << most;
    EXPECT_EQ(rig.arms[0]->slowness().empty(), full);
    auto about = nlohmann::json::parse(rig.about.json);
    ASSERT_EQ(about.at("slow_arms_push_less"), !full);
    if (full) about.erase("slow_arms_push_less");
    rig.about.json = about.dump();
    expectSame(rig.replay());
  }
}

/// Sets the first parameter of the first model before each tick, up and down.
void animate(Recorded& rig) {
  rig.every = [&rig, tick = 0](Nanoseconds) mutable {
    Order order;
    order.kind = Order::Kind::kSet;
    order.value = 3 + ++tick % 2;
    rig.loop->post(order);
  };
}

/// A recording that says nothing of the rule was made before there was one: what kicked then kicks again.
TEST(Replay, IsTheSameWhereAParameterWasSetInEveryTickUnderEitherLaw) {
  for (const bool former : {false, true}) {
    Recorded rig("obliging", {number(0, HSP_REAL, 3), number(1, HSP_BOOL, 1)});
    if (former) rig.holdToFormerClaims();
    animate(rig);
    rig.record();
    const Vector3d last = rig.world->core().force(0);
    EXPECT_EQ(last.norm() >= 3, former) << last.transpose();
    auto about = nlohmann::json::parse(rig.about.json);
    ASSERT_EQ(about.at("claims_hold_torques"), !former);
    if (former) about.erase("claims_hold_torques");
    rig.about.json = about.dump();
    expectSame(rig.replay());
  }
}

/// A wall that a program leads into the hand, and the program's memory as it was then.
TEST(Replay, IsTheSameWhereAModelWasLed) {
  scene::Model door = testModel("wall", {number(1, HSP_REAL, 5)});
  door.name = "door";
  door.kinematic = true;
  door.path = {{0, {{0, -0.1, 0}, Eigen::Quaterniond::Identity()}}};
  Recorded rig("wall", {}, {}, {door});
  link::PoseSlot slot, second;
  std::mt19937_64 random(3);
  int tick = 0;
  rig.every = [&](Nanoseconds now) {
    Order order;
    order.target = 1;
    const bool begins = tick == 20 || tick == 120;
    order.kind = begins ? Order::Kind::kLead : Order::Kind::kUnlead;
    order.slot = tick == 20 ? &slot : &second;
    if (begins || tick == 110) rig.loop->post(order);
    hapticd_target target{};
    target.position[1] = -0.1 + 0.002 * (tick - 20) + 1e-4 * static_cast<double>(random() % 10);
    target.linear[1] = 2;
    target.angular[0] = 0.3;
    target.orientation[0] = 1;
    target.time = tick % 2 == 0 ? 0 : static_cast<double>(now) * 1e-9;
    if (tick % 13 == 5) target.position[0] = HUGE_VAL;  // refused, then as in the replay, where it never was
    if (tick > 20 && random() % 3 != 0) (tick < 115 ? slot : second).put(target);
    ++tick;
  };
  rig.record();
  const record::FlightRing& ring = rig.telemetry->flight()->ring();
  EXPECT_GT(ring.written(kLeads), 80u);
  EXPECT_GT(rig.world->core().models()[1].pose.position[1], -0.05);
  EXPECT_GT(rig.world->core().models()[1].lead.refused(), 2u);
  expectSame(rig.replay());
}

/// Two programs push on the arm: one dies, writes nonsense and comes again, the other is late.
struct PushedOn {
  explicit PushedOn(Recorded& rig) {
    rig.every = [this, &rig](Nanoseconds) { before(rig); };
  }
  void before(Recorded& rig) {
    for (uint32_t place : {0u, 2u}) {
      Order order;
      order.param = static_cast<uint32_t>(Order::Led::kForce);
      order.place = place;
      order.kind = tick == 90 && place == 2 ? Order::Kind::kUnlead : Order::Kind::kLead;
      order.push = tick == 120 ? &again : &slots[place];
      if (tick == 10 || (tick == 90 && place == 2) || (tick == 120 && place == 2)) rig.loop->post(order);
      hapticd_push push{};
      push.tick = tick - random() % 3;
      for (double& force : push.force) force = static_cast<double>(random() % 1000) * 0.004 - 2;
      if (tick % 17 == 3) push.torque[1] = HUGE_VAL;  // refused
      const bool silent = place == 0 ? tick > 60 && tick < 80 : random() % 4 == 0;
      if (!silent && tick > 10) (place == 2 && tick >= 120 ? again : slots[place]).put(push);
    }
    most = std::max(most, rig.arms[0]->clients().force().norm());
    most_sent = std::max(most_sent, rig.arms[0]->force().norm());
    ++tick;
  }
  uint64_t tick = 0;
  double most = 0, most_sent = 0;
  link::PushSlot slots[3], again;
  std::mt19937_64 random{5};
};

TEST(Replay, IsTheSameWhereProgramsPushed) {
  for (const scene::ClientMode mode : {scene::ClientMode::kAdd, scene::ClientMode::kInstead}) {
    Recorded rig("wall", {}, {}, {}, {mode, 3, false});
    PushedOn pushed(rig);
    rig.record();
    const record::FlightRing& ring = rig.telemetry->flight()->ring();
    EXPECT_GT(ring.written(kPushes), 150u);
    EXPECT_GT(pushed.most, 1);
    EXPECT_GT(pushed.most_sent, 0.5);
    EXPECT_LE(pushed.most_sent, 5.0001) << "what programs want goes through the limits";
    EXPECT_GT(rig.arms[0]->clients().refused(), 5u);
    EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kStopped) << "nothing but the end of the run";
    expectSame(rig.replay());
  }
}

/// A program that pushes with 2 N along x.
void helpTheHand(Recorded& rig, link::PushSlot& slot, uint64_t tick) {
  if (tick == 5) {
    Order order;
    order.param = static_cast<uint32_t>(Order::Led::kForce);
    order.kind = Order::Kind::kLead;
    order.push = &slot;
    rig.loop->post(order);
  }
  hapticd_push push{};
  push.tick = tick;
  push.force[0] = 2;
  if (tick > 5) slot.put(push);
}

/// A recording that says nothing of the rule was made before there was one.
TEST(Replay, IsTheSameWhereProgramsPushedByEitherLawOfPassivity) {
  std::vector<double> damping;
  for (const bool former : {false, true}) {
    Recorded rig("wall", {}, {number(1, HSP_REAL, 0.02), number(2, HSP_ENUM, 7), number(5, HSP_REAL, 0.3)}, {},
                 {scene::ClientMode::kAdd, 3, false});  // it moves along x
    if (former) rig.pushByTheFormerLaw();
    link::PushSlot slot;
    rig.every = [&rig, &slot, tick = uint64_t{0}](Nanoseconds) mutable { helpTheHand(rig, slot, tick++); };
    rig.record();
    ASSERT_NE(rig.arms[0]->passivity(), nullptr);
    damping.push_back(rig.arms[0]->passivity()->damping());
    auto about = nlohmann::json::parse(rig.about.json);
    ASSERT_EQ(about.at("spares_steady_pushes"), !former);
    if (former) about.erase("spares_steady_pushes");
    rig.about.json = about.dump();
    expectSame(rig.replay());
  }
  EXPECT_NE(damping[0], damping[1]) << "two laws";
}

/// A recording that says nothing of the rule was made before there was one.
TEST(Replay, IsTheSameWhereADisabledModelIsDeeperThanTheOneThatIsFelt) {
  for (const bool former : {false, true}) {
    scene::Model lower = testModel("wall");
    lower.name = "lower";
    lower.pose.position.y() = -0.001;
    Recorded rig("wall", {}, {}, {lower});
    rig.counts_unfelt = former;
    rig.every = [&rig, tick = 0](Nanoseconds) mutable {
      if (tick++ != 50) return;
      Order order;
      order.kind = Order::Kind::kDisable;
      rig.loop->post(order);
    };
    rig.record();
    TickRow row{};
    ArmRow arm{};
    ASSERT_TRUE(rig.telemetry->flight()->read(20, row, arm));
    EXPECT_EQ(row.model, 0) << "it is the deepest";
    ASSERT_TRUE(rig.telemetry->flight()->read(150, row, arm));
    EXPECT_EQ(row.model, former ? 0 : 1);
    auto about = nlohmann::json::parse(rig.about.json);
    ASSERT_EQ(about.at("depth_of_felt_models"), !former);
    if (former) about.erase("depth_of_felt_models");
    rig.about.json = about.dump();
    expectSame(rig.replay());
  }
}

TEST(BlackBox, HasTheSameRowsAsTheShortOneThatItReplaces) {
  Recorded rig("wall", {});
  Rig plain(0, [](Nanoseconds) { return Nanoseconds{0}; }, Recorded::kTicks);
  plain.loop->run();
  rig.record();
  const auto expected = plain.telemetry->blackBox(), got = rig.telemetry->blackBox();
  ASSERT_EQ(got.size(), expected.size());
  for (size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].t, expected[i].t);
    EXPECT_EQ(got[i].position, expected[i].position);
    EXPECT_EQ(got[i].force, expected[i].force);
    EXPECT_EQ(got[i].depth_m, expected[i].depth_m);
    EXPECT_EQ(got[i].model, expected[i].model);
    EXPECT_EQ(got[i].status, expected[i].status);
    EXPECT_EQ(got[i].fault, expected[i].fault);
  }
}

}  // namespace
}  // namespace hapticd::servo
