// SPDX-License-Identifier: MIT
#include "arm.hpp"

#include <algorithm>

#include "base/clock.hpp"

namespace hapticd::haply {

Arm::~Arm() {
  end_ = true;
  thread_.join();
  hapticd_lead_end(lead_);
}

bool Arm::readState(hapticd_state& state) {
  constexpr int kPatienceMs = 500;
  hapticd_state newer;
  if (hapticd_next_state(client_, device_, UINT64_MAX, kPatienceMs, &state) != 1) return false;
  // The memory still exists after the daemon has ended, so only new ticks show that the daemon runs.
  return monotonicNow() < state.time_ns + kHoldsNs ||
         hapticd_next_state(client_, device_, state.tick, kPatienceMs, &newer) == 1;
}

Result<void> Arm::push(const double force[3]) {
  {
    const std::lock_guard guard(lock_);
    std::copy_n(force, 3, force_);
    heard_ns_ = monotonicNow();
  }
  if (lead_ != nullptr) return {};
  hapticd_error error;
  lead_ = hapticd_lead_force(client_, name_.c_str(), &error);
  if (lead_ == nullptr) return Error{error.text};
  if (const auto code = thread_.start("hapticd-push", [this] { run(); })) return Error{code.message()};
  return {};
}

void Arm::readForce(double force[3]) const {
  const std::lock_guard guard(lock_);
  const bool holds = monotonicNow() < heard_ns_ + kHoldsNs;
  for (int i = 0; i < 3; ++i) force[i] = holds ? force_[i] : 0;
}

void Arm::run() {
  constexpr int kClientPriority = 70, kLongestMs = 100;
  (void)os::setFifo(kClientPriority);  // without real-time rights the force comes one tick late
  uint64_t last = UINT64_MAX;
  while (!end_) {
    hapticd_state state;
    if (hapticd_next_state(client_, device_, last, kLongestMs, &state) != 1) continue;
    last = state.tick;
    hapticd_push push{};
    push.tick = state.tick;
    push.woke_ns = monotonicNow();
    readForce(push.force);
    push.written_ns = monotonicNow();
    hapticd_lead_push(lead_, &push);
  }
}

}  // namespace hapticd::haply
