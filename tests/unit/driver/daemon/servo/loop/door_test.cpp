// SPDX-License-Identifier: MIT
/// What programs outside are told beside the rows: states before the shapes are felt, and a bell.
#include "servo/loop/door.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <thread>

#include "link/lead.hpp"
#include "test_rig.hpp"

namespace hapticd::servo {
namespace {

struct alignas(64) Memory {
  std::byte bytes[Door::stateBytes(1)]{};
};

hapticd_state stateIn(Memory& memory) {
  hapticd_state state{};
  uint64_t seen = 0;
  EXPECT_TRUE(reinterpret_cast<link::StateSlot*>(memory.bytes + Door::kStateAt)->take(seen, state));
  return state;
}

TEST(Door, TellsTheStateOfTheTickThatGoesOn) {
  Memory memory;
  hapticd_bell bell{};
  std::vector<hapticd_state> states;
  states.reserve(1000);  // the clock runs in the servo thread, which must not allocate
  Rig* running = nullptr;
  Rig rig(0, [&](Nanoseconds) {
    if (running != nullptr && running->loop->ticks() > 0) states.push_back(stateIn(memory));
    return Nanoseconds{0};
  });
  running = &rig;
  rig.loop->door().showState(memory.bytes, 1);
  rig.loop->door().setBell(&bell);
  rig.loop->run();
  ASSERT_GT(states.size(), 100u);
  for (size_t i = 1; i < states.size(); ++i) {
    EXPECT_EQ(states[i].tick, states[i - 1].tick + 1);
    EXPECT_NEAR(states[i].t, static_cast<double>(states[i].tick) * 1e-3, 1e-9);
    EXPECT_EQ(states[i].flags, HAPTICD_GOOD + 0u);
  }
  const hapticd_state last = stateIn(memory);
  const Arm& arm = *rig.arms[0];
  EXPECT_EQ(Eigen::Vector3d(last.position), arm.probe().position);
  EXPECT_EQ(last.joint_count, arm.info().joint_count);
  EXPECT_EQ(last.joints[0], arm.sample().position[0]);
  const auto* page = reinterpret_cast<const hapticd_state_page*>(memory.bytes);
  EXPECT_EQ(page->arms, 1u);
  EXPECT_EQ(page->stride, Door::kStateStride);
  EXPECT_EQ(bell.rows, rig.loop->ticks());
  EXPECT_EQ(bell.state, rig.loop->ticks());
}

/// As a program outside waits: the flag, the word again, then the kernel.
bool waitFor(uint32_t& word, uint32_t& waiting, uint32_t seen) {
  std::atomic_ref<uint32_t>(waiting).store(1);
  if (std::atomic_ref<uint32_t>(word).load() != seen) return true;
  const timespec limit{5, 0};
  syscall(SYS_futex, &word, FUTEX_WAIT, seen, &limit, nullptr, 0);
  return std::atomic_ref<uint32_t>(word).load() != seen;
}

TEST(Door, WakesWhoWaitsAndForgetsWhoDoesNot) {
  alignas(64) hapticd_bell bell{};
  Door door;
  door.setBell(&bell);
  for (uint64_t tick = 0; tick < 200; ++tick) {
    bool woken = false;
    std::thread waiter([&] { woken = waitFor(bell.rows, bell.rows_waiting, static_cast<uint32_t>(tick)); });
    while (std::atomic_ref<uint32_t>(bell.rows_waiting).load() == 0) std::this_thread::yield();
    door.written(tick);
    waiter.join();
    ASSERT_TRUE(woken) << tick;
  }
  EXPECT_EQ(bell.rows, 200u);
  std::atomic_ref<uint32_t>(bell.rows_waiting).store(0);
  door.written(200);
  EXPECT_EQ(bell.rows_waiting, 0u);
  EXPECT_EQ(bell.state, 0u);
}

/// A crowd is not all woken in one tick, and nobody of it is forgotten.
TEST(Door, WakesACrowdOverSeveralTicks) {
  alignas(64) hapticd_bell bell{};
  Door door;
  door.setBell(&bell);
  std::atomic<int> asleep{0}, woken{0};
  std::vector<std::thread> crowd;
  for (int i = 0; i < 3 * Door::kMostWoken; ++i)
    crowd.emplace_back([&] {
      ++asleep;
      waitFor(bell.state, bell.state_waiting, 0);
      ++woken;
    });
  while (asleep < static_cast<int>(crowd.size())) std::this_thread::yield();
  const auto nothing = Arms();
  for (uint64_t tick = 0; woken < static_cast<int>(crowd.size()); ++tick) {
    ASSERT_LT(tick, 100'000u);
    door.publish({tick, 0, 0, 0}, nothing);
    std::this_thread::yield();
  }
  for (std::thread& one : crowd) one.join();
}

}  // namespace
}  // namespace hapticd::servo
