// SPDX-License-Identifier: MIT
#include "servo/loop/door.hpp"

#include <algorithm>
#include <new>

#include "base/not_real_time.hpp"
#include "base/thread_usage.hpp"
#include "link/lead.hpp"

namespace hapticd::servo {

static_assert(Door::kStateStride >= link::kJacobianAt + sizeof(link::JacobianSlot));

namespace {

link::StateSlot& slotAt(std::byte* page, size_t arm) noexcept HSP_RT {
  return *reinterpret_cast<link::StateSlot*>(page + Door::kStateAt + arm * Door::kStateStride);
}

link::JacobianSlot& jacobianAt(std::byte* page, size_t arm) noexcept HSP_RT {
  return *reinterpret_cast<link::JacobianSlot*>(page + Door::kStateAt + arm * Door::kStateStride + link::kJacobianAt);
}

hapticd_state stateOf(const TickTime& tick, const Arm& arm) noexcept HSP_RT {
  hapticd_state state{};
  const Probe& probe = arm.probe();
  state.tick = tick.number;
  state.time_ns = tick.time;
  state.t = tick.t, state.dt = tick.dt;
  std::copy_n(probe.position.data(), 3, state.position);
  std::copy_n(probe.velocity.data(), 3, state.velocity);
  storeQuaternion(probe.orientation, state.orientation);
  std::copy_n(arm.sample().position, std::min<size_t>(std::size(state.joints), HDV_MAX_JOINTS), state.joints);
  std::copy_n(arm.force().data(), 3, state.sent);
  state.flags = probe.valid ? uint32_t{HAPTICD_GOOD} : 0u;
  state.buttons = arm.sample().buttons;
  state.fault = static_cast<uint32_t>(arm.limiter().fault());
  state.joint_count = arm.info().joint_count;
  return state;
}

}  // namespace

void Door::showState(std::byte* page, uint32_t arms) noexcept {
  for (uint32_t i = 0; i < arms; ++i) {  // an empty slot is all zeros, as the page is already
    new (page + kStateAt + i * kStateStride) link::StateSlot;
    new (page + kStateAt + i * kStateStride + link::kJacobianAt) link::JacobianSlot;
  }
  new (page) hapticd_state_page{arms, kStateStride, {}};
  state_.store(page, std::memory_order_release);
}

void Door::write(std::byte* page, const TickTime& tick, const Arms& arms) noexcept HSP_RT {
  hapticd_jacobian jacobian;
  jacobian.tick = tick.number;
  for (size_t i = 0; i < arms.size(); ++i) {
    // The Jacobian is written before the state, because a polling program may answer as soon as it sees the new state.
    if (arms[i]->clients().possible() && arms[i]->jacobian(jacobian.rows)) jacobianAt(page, i).put(jacobian);
    slotAt(page, i).put(stateOf(tick, *arms[i]));
  }
}

/// Writes the new tick, then checks whether a program waits. Both are sequentially consistent, so a program that sets
/// its flag after this check sees the new tick before it sleeps.
void Door::ring(uint32_t& word, uint32_t& waiting, uint64_t tick) noexcept HSP_RT {
  std::atomic_ref<uint32_t>(word).store(static_cast<uint32_t>(tick + 1));
  const std::atomic_ref<uint32_t> flag(waiting);
  if (flag.load() == 0) return;
  flag.store(0);
  const NotRealTime the_one_call;                                       // this system call never blocks
  if (os::wakeWaiting(&word, kMostWoken) == kMostWoken) flag.store(1);  // the next tick wakes the others
}

}  // namespace hapticd::servo
