// SPDX-License-Identifier: MIT
/// Waiting for the servo, which answers at its next tick or is stuck.
#pragma once
#include "base/clock.hpp"

namespace hapticd::servo {

/// [any] Looks every millisecond. True once `done` is, false after 2 s.
template <class Done>
bool waitUntil(Done&& done) {
  constexpr Nanoseconds kPause = 1'000'000, kPatience = 2'000'000'000;
  RealClock clock(0);
  for (const Nanoseconds end = clock.now() + kPatience; clock.now() < end; clock.waitUntil(clock.now() + kPause))
    if (done()) return true;
  return done();
}

}  // namespace hapticd::servo
