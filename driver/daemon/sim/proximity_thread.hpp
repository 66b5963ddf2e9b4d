// SPDX-License-Identifier: MIT
/// Runs the proximity search in runs on a real clock. Without surfaces no search is needed. If there is only one small
/// surface, the main thread searches, because it would otherwise only wait. In all other cases a separate thread
/// searches.
#pragma once
#include <algorithm>
#include <atomic>
#include <functional>

#include "base/clock.hpp"
#include "base/code_owner.hpp"
#include "base/os.hpp"
#include "sim/proximity.hpp"

namespace hapticd::sim {

class ProximityThread {
 public:
  /// @param wants_search [any] returns true if a search is needed now, without waiting for the period
  ProximityThread(Proximity& proximity, std::function<bool()> wants_search)
      : proximity_(proximity), needs_search_(std::move(wants_search)) {}
  ~ProximityThread() { stop(); }

  /// [main] Searches once, so that tracing starts with the first tick.
  std::error_code start() {
    const Searching amount = proximity_.amount();
    if (amount == Searching::kNone) return {};
    proximity_.search();
    return amount == Searching::kLarge ? startThread() : std::error_code();
  }

  /// [main] Runs a small search, or starts the search thread once the models need it. If the search thread cannot
  /// start, the calling thread keeps searching. @return time to wait until the next call [ns], at most `rest`
  Nanoseconds turn(Nanoseconds rest) {
    if (thread_.running()) return rest;
    const Searching amount = proximity_.amount();
    if (amount == Searching::kNone || (amount == Searching::kLarge && !startThread())) return rest;
    proximity_.search();
    return std::min(rest, link::kSearchPeriod);
  }

  void stop() {  ///< [main] ends the thread, if there is one
    stop_ = true;
    thread_.join();
  }

 private:
  std::error_code startThread() {
    return thread_.start("hapticd-sim", [this] { loop(); });
  }

  void loop() {
    constexpr Nanoseconds kPoll = 1'000'000;  // longest delay of an urgent search
    const WorkerScope working(Worker::kSearch);
    RealClock clock(0);
    for (Nanoseconds next = clock.now(); !stop_;) {
      const Nanoseconds now = clock.waitUntil(clock.now() + kPoll);
      if (now < next && !needs_search_()) continue;
      next = now + link::kSearchPeriod;
      proximity_.search();
    }
  }

  Proximity& proximity_;
  std::function<bool()> needs_search_;
  std::atomic<bool> stop_{false};
  os::Thread thread_;
};

}  // namespace hapticd::sim
