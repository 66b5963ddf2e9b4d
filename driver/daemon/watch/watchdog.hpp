// SPDX-License-Identifier: MIT
/// Watches the servo from a thread above it: a tick that does not end has its motors cut within 5 ms, and a servo that
/// never comes back ends the process, so that the service manager starts it anew without the plugin.
#pragma once
#include <atomic>
#include <functional>
#include <system_error>

#include "base/os.hpp"
#include "watch/watched.hpp"

namespace hapticd::watch {

class Watchdog {
 public:
  static constexpr Nanoseconds kCheckEvery = 1'000'000;
  static constexpr Nanoseconds kOnTime = 2 * kCheckEvery;  ///< a longer way between two looks: it was held up itself
  static constexpr Nanoseconds kStuckAfter = 3'000'000;    ///< with the look and the cut itself below 5 ms
  static constexpr Nanoseconds kHungAfter = 500'000'000;   ///< nothing comes back after that
  static constexpr Nanoseconds kSimulatedPause = 200'000'000;  ///< a busy machine may pause a simulation so long

  /// [main] @param hung what ends the process
  Watchdog(Watched& servo, std::function<void()> hung) : servo_(servo), hung_(std::move(hung)) {}
  ~Watchdog() { stop(); }

  /// [main] @param priority SCHED_FIFO, above the servo's; without the right it runs as an ordinary thread
  std::error_code start(int priority);
  void stop();

  /// [any] One look; the thread does nothing else. True: it cut. A look that comes late saw nothing of the time before
  /// it: the whole machine may have stood still, this thread and the servo alike. Such a time counts as one way between
  /// two looks, so that the servo gets a moment to end its tick; a servo that is stuck is then cut by the fourth look
  /// at the latest, which is within 4 ms once the looks are on time.
  bool check(Nanoseconds now) noexcept;

  uint64_t cuts() const noexcept { return cuts_.load(); }

 private:
  Watched& servo_;
  std::function<void()> hung_;
  bool mayBePaused(Nanoseconds stuck) const noexcept;

  uint64_t cut_tick_ = UINT64_MAX;  ///< the tick that was cut, once
  uint64_t tick_ = UINT64_MAX;
  Nanoseconds checks_since_cut_ = 0;
  Nanoseconds cpu_at_tick_ = 0;
  Nanoseconds looked_at_ = 0;  ///< the last time
  Nanoseconds counted_ = 0;    ///< of the tick going on, as far as it was watched
  std::atomic<uint64_t> cuts_{0};
  std::atomic<bool> stop_{false};
  os::Thread thread_;
};

}  // namespace hapticd::watch
