// SPDX-License-Identifier: MIT
/// Waits until something happens that nobody announces.
#pragma once
#include "base/clock.hpp"

namespace hapticd {

/// [any] Calls `done` at once and after each pause, until it returns true. Returns false if that does not happen within
/// `patience` [ns]. It sleeps, so the servo thread must not call it.
template <class Done>
bool happensWithin(Nanoseconds patience, Nanoseconds pause, Done&& done) {
  RealClock clock(0);
  for (const Nanoseconds end = clock.now() + patience; clock.now() < end; clock.waitUntil(clock.now() + pause))
    if (done()) return true;
  return done();
}

}  // namespace hapticd
