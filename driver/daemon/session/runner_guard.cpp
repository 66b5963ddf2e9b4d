// SPDX-License-Identifier: MIT
/// The guard process of a run: which runs have one, and how it is kept up to date.
#include <algorithm>
#include <utility>

#include "log/log.hpp"
#include "session/runner.hpp"
#include "watch/watchdog.hpp"

namespace hapticd::servo {

/// True for an arm whose hardware does not switch itself off, and which another process can switch off.
bool Runner::needsGuard() const {
  if (options_.virtual_time) return false;
  return std::any_of(arms_.begin(), arms_.end(), [](const auto& arm) {
    return !arm->simulated() && (arm->info().capabilities & HDV_C_WATCHDOG) == 0 && arm->device().silenceable();
  });
}

void Runner::startGuard() {
  constexpr Nanoseconds kAfterTheWatchdog = 2;  // whose cut comes first
  const Nanoseconds patience =
      kAfterTheWatchdog * (mayLag() ? watch::Watchdog::kMissedInVirtualMachine : watch::Watchdog::kMissedAfter);
  auto guard = watch::GuardProcess::start(options_.priority + 2, patience);
  if (!guard) return warnings_.push_back(guard.error());
  guard_ = std::move(*guard);
  loop_->beatOn(guard_->ticks());
}

/// A guard that was killed, as on a machine short of memory, would not be missed until it is needed.
void Runner::keepGuard() {
  constexpr uint32_t kMost = 8;
  if (guards_ended_ > kMost) return;
  if (guard_->alive()) return tellGuard();
  const bool again = ++guards_ended_ <= kMost;
  const Result<void> begun = again ? guard_->restart() : Error{"it ended repeatedly"};
  log::write(begun ? HSP_LOG_WARNING : HSP_LOG_ERROR, "",
             begun ? "the guard process ended; another watches in its place"
                   : "the guard process ended, and there is no other: " + begun.error());
  if (!begun) guards_ended_ = kMost + 1;
}

/// Arms come and go: an arm that was found anew must be reached in another way.
void Runner::tellGuard() {
  for (uint32_t i = 0; i < arms_.size(); ++i) {
    hdv_silence how{};
    const bool there = !arms_[i]->simulated() && arms_[i]->device().silence(how);
    guard_->tell(i, there ? &how : nullptr);
  }
  if (loop_->ticks() > 0 && !loop_->finished()) guard_->arm(true);
}

}  // namespace hapticd::servo
