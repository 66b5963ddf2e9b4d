// SPDX-License-Identifier: MIT
#include "watch/watchdog.hpp"

#include <algorithm>
#include <utility>

namespace hapticd::watch {

std::error_code Watchdog::start(int priority) {
  stop_ = false;
  return thread_.start("hapticd-watch", [this, priority] {
    (void)os::setFifo(priority);  // if this is refused, the thread watches as an ordinary thread
    RealClock clock(0);
    while (!stop_) {
      clock.waitUntil(clock.now() + kCheckEvery);
      check(clock.now());
    }
  });
}

void Watchdog::stop() {
  stop_ = true;
  thread_.join();
}

bool Watchdog::check(Nanoseconds now) noexcept {
  const Nanoseconds elapsed = now - std::exchange(looked_at_, now);
  const Nanoseconds seen = elapsed <= kOnTime ? elapsed : kLateCounts;
  watchEnd();
  const uint64_t tick = servo_.ticks();
  const Nanoseconds begun = servo_.tickBegun(), next = servo_.nextTick();
  if (begun != 0 && now > begun) return checkPhase({tick, false}, now - begun, seen);
  // In a simulation, late ticks can hurt nobody.
  if (begun == 0 && next != 0 && now > next && !servo_.simulated()) return checkPhase({tick, true}, now - next, seen);
  phase_ = {};
  watchResting();
  return false;
}

/// Ends the process if a module does not return from a call in which no motor needs to be cut: before the first tick,
/// and between the ticks of a simulation. Time is counted as in watchHung().
void Watchdog::watchResting() noexcept {
  const uint64_t beats = servo_.beats();
  if (std::exchange(beats_, beats) != beats || servo_.inServo() == nullptr) checks_since_beat_ = 0;
  if (++checks_since_beat_ * kCheckEvery == (servo_.simulated() ? kHungSimulated : kHungAfter)) hung_();
}

/// Ends the process if its end was asked for some time ago: a plugin that takes long, or never returns, must not delay
/// it.
void Watchdog::watchEnd() noexcept {
  if (servo_.stopAsked() != 0 && ++checks_since_stop_ == kEndWithin / kCheckEvery && late_) late_();
}

/// Judges the present phase at one check, and returns true if it cut the motors. @param overdue [ns] time since the
/// tick began, or should have begun @param seen [ns] part of the time before this check that counts
bool Watchdog::checkPhase(Phase phase, Nanoseconds overdue, Nanoseconds seen) noexcept {
  if (!(phase == phase_)) {  // the first check in this phase
    phase_ = phase;
    cpu_at_phase_ = servo_.cpuTime();
    counted_ = 0;
  }
  counted_ = std::min(overdue, counted_ + seen);
  if (cut_in_ == phase) {
    watchHung(phase);
    return false;
  }
  if (counted_ <= patience(phase) || mayBePaused(phase, overdue)) return false;
  servo_.cut(static_cast<double>(overdue) * kSecondsPerNanosecond);
  cut_in_ = phase;
  checks_since_cut_ = 0;
  hung_told_ = false;
  ++cuts_;
  return true;
}

/// Time is counted by the number of checks, not by a clock, so that a tick during which the machine slept does not
/// count as hanging. A servo that merely gets no processor does not hang either.
void Watchdog::watchHung(Phase phase) noexcept {
  if (hung_told_ || (phase.waits && servo_.inServo() == nullptr)) return;
  const Nanoseconds looked = ++checks_since_cut_ * kCheckEvery;
  const bool starved = servo_.simulated() && servo_.cpuTime() - cpu_at_phase_ < kHungAfter;
  if (looked < (starved ? kHungSimulated : kHungAfter)) return;
  hung_told_ = true;
  hung_();
}

Nanoseconds Watchdog::patience(Phase phase) const noexcept {
  if (phase.waits) return missed_after_;
  return servo_.simulated() ? std::max(stuck_after_, kStuckSimulated) : stuck_after_;
}

/// True if the arm is simulated, so that no hand can be hurt, and the thread may merely not have been scheduled.
bool Watchdog::mayBePaused(Phase phase, Nanoseconds stuck) const noexcept {
  const bool works = !phase.waits && servo_.cpuTime() - cpu_at_phase_ + kCheckEvery > kStuckSimulated;
  return servo_.simulated() && !works && stuck <= kSimulatedPause;
}

}  // namespace hapticd::watch
