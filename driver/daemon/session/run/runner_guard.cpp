// SPDX-License-Identifier: MIT
/// The guard process of a run: decides which runs have one, and keeps it up to date.
#include <algorithm>
#include <utility>

#include "log/log.hpp"
#include "session/run/runner.hpp"
#include "watch/watchdog.hpp"

namespace hapticd::servo {

/// True if an arm does not switch its motors off by itself, but another process can switch them off.
bool Runner::needsGuard() const {
  if (options_.virtual_time) return false;
  return std::any_of(arms_.begin(), arms_.end(), [](const auto& arm) {
    return !arm->simulated() && (arm->info().capabilities & HDV_C_WATCHDOG) == 0 && arm->device().silenceable();
  });
}

void Runner::startGuard() {
  constexpr Nanoseconds kAfterTheWatchdog = 2;  // times the watchdog's patience, so that the watchdog cuts first
  const Nanoseconds patience =
      kAfterTheWatchdog * (mayLag() ? watch::Watchdog::kMissedInVirtualMachine : watch::Watchdog::kMissedAfter);
  auto guard = watch::GuardProcess::start(options_.priority + 2, patience);
  if (!guard) return warnings_.push_back(guard.error());
  guard_ = std::move(*guard);
  loop_->beatOn(guard_->ticks());
}

/// Restarts a guard that was killed, for example because the machine ran out of memory. Otherwise its end would only be
/// noticed when it is needed.
void Runner::keepGuard() {
  constexpr uint32_t kMost = 8;
  if (guards_ended_ > kMost) return;
  if (guard_->alive()) return updateGuard();
  const bool again = ++guards_ended_ <= kMost;
  const Result<void> begun = again ? guard_->restart() : Error{"it ended repeatedly"};
  log::write(begun ? HSP_LOG_WARNING : HSP_LOG_ERROR, "",
             begun ? "the guard process ended; a new one has replaced it"
                   : "the guard process ended and could not be replaced: " + begun.error());
  if (!begun) guards_ended_ = kMost + 1;
}

/// Tells the guard how to reach the arms, because this changes when an arm is plugged in again.
void Runner::updateGuard() {
  for (uint32_t i = 0; i < arms_.size(); ++i) {
    hdv_silence how{};
    const bool there = !arms_[i]->simulated() && arms_[i]->device().silence(how);
    guard_->sendSilence(i, there ? &how : nullptr);
  }
  if (loop_->ticks() > 0 && !loop_->finished()) guard_->arm(true);
}

}  // namespace hapticd::servo
