// SPDX-License-Identifier: MIT
/// Forces of programs outside: whatever they write, the hand feels no more than the bound, and nothing 20 ms after they
/// fell silent.
#include "servo/arm/client_forces.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

namespace hapticd::servo {
namespace {

constexpr double kBound = 4;   // [N]
constexpr double kTorque = 1;  // [N m]

struct Pushed {
  explicit Pushed(scene::ClientMode mode = scene::ClientMode::kAdd, double rate = 1000)
      : dt(1 / rate), forces({mode, kBound, false}, 10, kTorque, dt) {}

  /// One tick; `x` [N] of program 0, unless it is silent.
  void tick(std::optional<double> x = std::nullopt) {
    if (x) put(0, *x);
    forces.collect(now++, dt);
  }
  void put(size_t place, double x, int64_t late = 0) {
    hapticd_push push{};
    push.tick = static_cast<uint64_t>(static_cast<int64_t>(now) - late);
    push.force[0] = x;
    push.torque[1] = x / 100;
    slots[place].put(push);
  }
  void begin(uint32_t place = 0) { forces.begin(place, slots[place]); }
  void run(double seconds, std::optional<double> x) {
    for (int i = 0; i < std::lround(seconds / dt); ++i) tick(x);
  }
  double x() const { return forces.force().x(); }

  double dt;
  uint64_t now = 1000;
  std::vector<link::PushSlot> slots{ClientForces::kMost};
  ClientForces forces;
};

/// The one program at `slot` answers a tick with this force along z and this torque about it.
void answer(ClientForces& forces, link::PushSlot& slot, uint64_t tick, double force, double torque) {
  hapticd_push push{};
  push.tick = tick;
  push.force[2] = force, push.torque[2] = torque;
  slot.put(push);
  forces.collect(tick, 1e-3);
}

TEST(ClientForces, FadesInAndIsThenWhatTheProgramWants) {
  Pushed p;
  p.begin();
  double last = 0;
  for (int i = 0; i < 50; ++i) {
    p.tick(2);
    EXPECT_LE(p.x() - last, 2 * 1e-3 / ClientForces::kFadeIn * 1.0001);
    EXPECT_GE(p.x(), last);
    last = p.x();
  }
  p.tick(2);
  EXPECT_EQ(p.x(), 2);
  EXPECT_EQ(p.forces.torque().y(), 0.02);
  p.tick(-1);
  EXPECT_EQ(p.x(), -1);
}

TEST(ClientForces, TellsOfLateAnswersAndOfTheForceThatIsFelt) {
  Pushed p;
  p.begin();
  p.run(0.1, 2);
  const ClientForces::Client& client = p.forces.clients()[0];
  EXPECT_EQ(client.felt.load(), 2);
  EXPECT_EQ(client.next_tick.load(), 0u);
  for (int i = 0; i < 10; ++i) {
    p.put(0, 1, 1);
    p.tick();
  }
  EXPECT_EQ(client.next_tick.load(), 9u) << "the first answers a tick that was answered already";
  EXPECT_EQ(client.felt.load(), 1);
  EXPECT_EQ(client.largest.load(), 2);
  p.run(0.1, std::nullopt);
  EXPECT_EQ(client.felt.load(), 0);
  p.begin();
  EXPECT_EQ(client.largest.load(), 0) << "of the one before";
}

TEST(ClientForces, WhoLeavesHasNotFallenSilent) {
  Pushed p;
  p.begin();
  p.run(0.1, 2);
  p.forces.end(0);
  p.run(0.1, std::nullopt);
  EXPECT_EQ(p.forces.clients()[0].silences.load(), 0u);
}

TEST(ClientForces, AwaitsWhoKeepsUpAndHasNotAnsweredYet) {
  Pushed p;
  EXPECT_FALSE(p.forces.awaits(p.now)) << "nobody is there";
  p.begin();
  EXPECT_FALSE(p.forces.awaits(p.now)) << "has never answered";
  p.tick(1);
  EXPECT_TRUE(p.forces.awaits(p.now));
  p.put(0, 1, 1);
  EXPECT_TRUE(p.forces.awaits(p.now)) << "answers the tick before";
  p.put(0, 1);
  EXPECT_FALSE(p.forces.awaits(p.now));
  p.run(2e-3, std::nullopt);
  EXPECT_TRUE(p.forces.awaits(p.now)) << "one answer may be lost";
  p.run(1e-3, std::nullopt);
  EXPECT_FALSE(p.forces.awaits(p.now)) << "is too slow to wait for";
  p.tick(1);
  p.begin(1);
  EXPECT_TRUE(p.forces.awaits(p.now));
  p.forces.end(0);
  EXPECT_FALSE(p.forces.awaits(p.now));
}

TEST(ClientForces, TurnsTheHandOnlyAsFarAsTheDeviceFileLets) {
  for (const double most : {0.0, 0.1, 2.0}) {
    ClientForces forces({scene::ClientMode::kAdd, kBound, false}, 10, most, 1e-3);
    link::PushSlot slot;
    forces.begin(0, slot);
    for (uint64_t tick = 1000; tick < 1100; ++tick) {
      answer(forces, slot, tick, 0, -1e6);
      ASSERT_LE(forces.torque().norm(), most * (1 + 1e-12));
    }
    EXPECT_NEAR(forces.torque().z(), -most, 1e-9);
  }
}

TEST(ClientForces, IsGoneTwentyMillisecondsAfterTheLastAnswer) {
  for (const double rate : {500.0, 1000.0, 1500.0, 4000.0, 10000.0}) {
    Pushed p(scene::ClientMode::kAdd, rate);
    p.begin();
    p.run(0.2, 3);
    ASSERT_EQ(p.x(), 3) << rate;
    p.run(ClientForces::kSilentAfter - p.dt, std::nullopt);
    EXPECT_EQ(p.x(), 3) << "a late answer is no silence, at " << rate;
    double last = 3, silent = ClientForces::kSilentAfter - p.dt;
    for (; p.x() != 0; silent += p.dt) {
      p.tick();
      ASSERT_LE(p.x(), last);
      EXPECT_LE(last - p.x(), 3 * p.dt / ClientForces::kFadeOut * 1.0001) << "a ramp and no step, at " << rate;
      last = p.x();
      ASSERT_LT(silent, 1);
    }
    EXPECT_LE(silent, 0.02 + p.dt * 0.5) << rate;
    EXPECT_EQ(p.forces.clients()[0].silences.load(), 1u);
    p.tick(3);
    EXPECT_LE(p.x(), 3 * p.dt / ClientForces::kFadeIn * 1.0001) << "back in a ramp";
  }
}

TEST(ClientForces, RampsOutAfterItsProgramHasGoneWithoutItsMemory) {
  Pushed p;
  p.begin();
  p.run(0.1, 3);
  p.forces.end(0);
  p.slots.clear();  // unmapped
  p.run(0.016, std::nullopt);
  EXPECT_GT(p.x(), 0);
  EXPECT_TRUE(p.forces.present());
  p.run(0.002, std::nullopt);
  EXPECT_EQ(p.x(), 0);
  EXPECT_FALSE(p.forces.present());
}

TEST(ClientForces, AddUpAndAreBoundedOneByOne) {
  Pushed p;
  p.begin(0);
  p.begin(3);
  for (int i = 0; i < 100; ++i) {
    p.put(3, 1.5);
    p.tick(1000);
  }
  EXPECT_DOUBLE_EQ(p.x(), kBound + 1.5);
  ClientForces of_weak_arm({scene::ClientMode::kAdd, 0, false}, 2.5, kTorque, 1e-3);
  link::PushSlot slot;
  of_weak_arm.begin(0, slot);
  for (uint64_t tick = 0; tick < 100; ++tick) answer(of_weak_arm, slot, tick, -30, 0);
  EXPECT_DOUBLE_EQ(of_weak_arm.force().z(), -2.5);
}

TEST(ClientForces, TakesNoAnswerTwiceNorAnOldOne) {
  Pushed p;
  p.begin();
  p.run(0.1, 1);
  const uint64_t answers = p.forces.clients()[0].answers.load();
  p.put(0, 2, 1);  // to the tick that was answered already
  p.tick();
  EXPECT_EQ(p.x(), 1);
  p.run(0.1, std::nullopt);
  p.put(0, 2, 25);  // newer than the last, and too old all the same
  p.tick();
  EXPECT_EQ(p.x(), 0);
  EXPECT_EQ(p.forces.clients()[0].answers.load(), answers);
  EXPECT_EQ(p.forces.clients()[0].in_time.load(), answers);
  p.put(0, 2, 2);  // a little late
  p.tick();
  EXPECT_GT(p.x(), 0);
  EXPECT_EQ(p.forces.clients()[0].in_time.load(), answers);
  EXPECT_EQ(p.forces.refused(), 0u);
}

TEST(ClientForces, RefusesAndCountsNonsense) {
  Pushed p;
  p.begin();
  uint64_t refused = 0;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300, -1.01e6}) {
    p.tick(bad);
    EXPECT_EQ(p.forces.refused(), ++refused) << bad;
    EXPECT_EQ(p.x(), 0);
  }
  p.put(0, 1, -1);  // a tick that is yet to come
  p.tick();
  EXPECT_EQ(p.forces.refused(), ++refused);
}

TEST(ClientForces, InsteadOfTheModelsTheyFadeOutAndComeBack) {
  Pushed p(scene::ClientMode::kInstead);
  p.begin();
  EXPECT_EQ(p.forces.share(), 1);
  p.run(0.06, 1);
  EXPECT_EQ(p.forces.share(), 0);
  EXPECT_EQ(p.x(), 1);
  double last = 0;
  for (int i = 0; i < 80; ++i) {
    p.tick();
    EXPECT_LE(p.forces.share() - last, 1e-3 / ClientForces::kFadeIn * 1.0001) << "they come back in a ramp";
    last = p.forces.share();
  }
  EXPECT_EQ(p.forces.share(), 1);
}

/// Every byte of the memory may be anything at any time.
TEST(ClientForces, KeepTheirBoundsUnderAMillionFuzzedRecords) {
  Pushed p;
  for (uint32_t place = 0; place < ClientForces::kMost; ++place) p.begin(place);
  std::mt19937_64 random(11);
  constexpr double kEdges[] = {0, 1, -1, 3.99, 4.01, 1e6, 1.1e6, 1e300, 5e-324, HUGE_VAL};
  uint64_t taken = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    const size_t place = random() % ClientForces::kMost;
    hapticd_push push{};
    push.tick = random() % 4 != 0 ? p.now - random() % 3 : random();
    auto* numbers = reinterpret_cast<double*>(&push) + 1;
    for (uint64_t n = random() % 4; n > 0; --n)
      numbers[random() % 6] =
          random() % 2 == 0 ? std::bit_cast<double>(random()) : kEdges[random() % std::size(kEdges)];
    p.slots[place].put(push);
    if (random() % 16 == 0) reinterpret_cast<uint64_t*>(&p.slots[place])[0] = random();
    if (random() % 4096 == 0) p.forces.end(static_cast<uint32_t>(place)), p.begin(static_cast<uint32_t>(place));
    p.tick();
    ASSERT_TRUE(p.forces.torque().allFinite()) << i;
    ASSERT_LE(p.forces.force().norm(), kBound * ClientForces::kMost * 1.0001) << i;
  }
  for (const auto& client : p.forces.clients()) taken += client.answers.load();
  EXPECT_GT(p.forces.refused(), 100'000u);
  EXPECT_GT(taken, 1000u) << "the bounds were put to the test";
}

}  // namespace
}  // namespace hapticd::servo
