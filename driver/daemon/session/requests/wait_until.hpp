// SPDX-License-Identifier: MIT
/// Waits for the servo to carry out an order. The servo does so in its next tick, unless it is stuck.
#pragma once
#include "base/clock.hpp"

namespace hapticd::servo {

/// [any] Calls `done` every millisecond. Returns true once `done` returns true, and false after 2 s.
template <class JobResult>
bool waitUntil(JobResult&& done) {
  constexpr Nanoseconds kPause = 1'000'000, kPatience = 2'000'000'000;
  RealClock clock(0);
  for (const Nanoseconds end = clock.now() + kPatience; clock.now() < end; clock.waitUntil(clock.now() + kPause))
    if (done()) return true;
  return done();
}

}  // namespace hapticd::servo
