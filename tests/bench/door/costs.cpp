// SPDX-License-Identifier: MIT
/// Measures everything in one thread with warm caches. So the times contain the work of the processor, but not the
/// transfer of cache lines from another core.
#include <cstdio>

#include "base/clock.hpp"
#include "bench.hpp"
#include "servo/arm/client_forces.hpp"
#include "servo/core/led_pose.hpp"
#include "servo/loop/door.hpp"

namespace hapticd::bench {

namespace {

constexpr int kTicks = 2'000'000;
constexpr double kPeriod = 1e-3;  // [s]

/// Prints the time per call [ns], less that of a loop that only makes the same preparation.
template <class Prepare, class Call>
void cost(const char* what, Prepare&& prepare, Call&& call) {
  double spent[2] = {};
  for (const bool with : {false, true}) {
    const Nanoseconds begun = monotonicNow();
    for (int i = 0; i < kTicks; ++i) {
      prepare(i);
      if (with) call(i);
      asm volatile("" ::: "memory");
    }
    spent[with ? 1 : 0] = static_cast<double>(monotonicNow() - begun);
  }
  std::printf("%-58s %7.1f ns\n", what, (spent[1] - spent[0]) / kTicks);
}

void nothing(int) {}

void poses() {
  link::PoseSlot slot;
  hsp_pose pose{};
  pose.orientation[0] = 1;
  servo::LedPose led;
  led.begin(slot, pose);
  const auto step = [&](int i) { led.step(i * kPeriod, kPeriod, 0, pose); };
  cost("a model that is led, at rest, no news", nothing, step);
  hapticd_target target{};
  target.orientation[0] = 1;
  const auto news = [&](int i) {
    target.position[0] = 1e-3 * (i % 50);
    slot.put(target);
  };
  cost("a model that is led, news every tick", news, step);
}

void pushes() {
  servo::ClientForces forces({scene::ClientMode::kAdd, 3, false}, 10, 1, kPeriod);
  uint64_t tick = 0;
  const auto collect = [&](int) { forces.collect(tick++, kPeriod); };
  cost("an arm that may be pushed, nobody there", nothing, collect);
  link::PushSlot slots[servo::ClientForces::kMost];
  for (uint32_t programs = 1, next = 0; programs <= servo::ClientForces::kMost; programs *= 8) {
    for (; next < programs; ++next) forces.begin(next, slots[next]);
    hapticd_push push{};
    push.force[0] = 1;
    char what[80];
    std::snprintf(what, sizeof what, "an arm pushed by %u, which answer every tick", programs);
    const auto answer = [&](int) {
      push.tick = tick;
      for (uint32_t i = 0; i < programs; ++i) slots[i].put(push);
    };
    cost(what, answer, collect);
    std::snprintf(what, sizeof what, "an arm pushed by %u, which are silent", programs);
    cost(what, nothing, collect);
  }
}

void bells() {
  servo::Door door;
  const servo::Arms none;
  const auto both = [&](int i) {
    door.publish({static_cast<uint64_t>(i), 0, 0, 0}, none);
    door.written(static_cast<uint64_t>(i));
  };
  cost("nobody asked for states or the bell", nothing, both);
  static hapticd_bell bell{};
  door.setBell(&bell);
  cost("the bell, nobody waits", nothing, both);
  cost("the bell, somebody says that he waits (one FUTEX_WAKE)", [](int) { bell.rows_waiting = 1; }, both);
}

}  // namespace

void costs() {
  poses();
  pushes();
  bells();
}

}  // namespace hapticd::bench
