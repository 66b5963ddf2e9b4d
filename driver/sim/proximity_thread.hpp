/// The proximity search on a thread of its own, for runs on a real clock.
#pragma once
#include <atomic>
#include <functional>

#include "base/clock.hpp"
#include "base/os.hpp"
#include "sim/proximity.hpp"

namespace hapticd::sim {

class ProximityThread {
 public:
  /// @param wants_search [any] true: search now, without waiting for the period
  ProximityThread(Proximity& proximity, std::function<bool()> wants_search)
      : proximity_(proximity), wants_search_(std::move(wants_search)) {}
  ~ProximityThread() { stop(); }

  /// [main] Searches once, so that tracing starts with the first tick, then goes on in the thread.
  std::error_code start() {
    proximity_.search();
    return thread_.start("hapticd-sim", [this] { loop(); });
  }

  void stop() {  ///< [main]
    stop_ = true;
    thread_.join();
  }

 private:
  void loop() {
    constexpr Nanoseconds kPoll = 1'000'000;  // an urgent search waits no longer than this
    RealClock clock(0);
    for (Nanoseconds next = clock.now(); !stop_;) {
      const Nanoseconds now = clock.waitUntil(clock.now() + kPoll);
      if (now < next && !wants_search_()) continue;
      next = now + kSearchPeriod;
      proximity_.search();
    }
  }

  Proximity& proximity_;
  std::function<bool()> wants_search_;
  std::atomic<bool> stop_{false};
  os::Thread thread_;
};

}  // namespace hapticd::sim
