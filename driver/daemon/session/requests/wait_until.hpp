// SPDX-License-Identifier: MIT
/// Waits for the servo to carry out an order. The servo does so in its next tick, unless it is stuck.
#pragma once
#include "base/happens_within.hpp"

namespace hapticd::servo {

/// [any] Calls `done` every millisecond. Returns true once `done` returns true, and false after 2 s.
template <class Done>
bool waitUntil(Done&& done) {
  constexpr Nanoseconds kPause = 1'000'000, kPatience = 2'000'000'000;
  return happensWithin(kPatience, kPause, done);
}

}  // namespace hapticd::servo
