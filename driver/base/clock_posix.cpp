// SPDX-License-Identifier: MIT
#include <cerrno>
#include <ctime>

#include "base/clock.hpp"

namespace hapticd {

Nanoseconds monotonicNow() noexcept HSP_RT {
  timespec ts;
  clock_gettime(CLOCK_MONOTONIC, &ts);
  return static_cast<Nanoseconds>(ts.tv_sec) * kNanosecondsPerSecond + static_cast<Nanoseconds>(ts.tv_nsec);
}

Nanoseconds RealClock::now() noexcept HSP_RT {
  return monotonicNow();
}

Nanoseconds RealClock::waitUntil(Nanoseconds deadline) noexcept HSP_RT {
  if (deadline > spin_) {
    const Nanoseconds wake = deadline - spin_;
    const timespec ts{static_cast<time_t>(wake / kNanosecondsPerSecond),
                      static_cast<long>(wake % kNanosecondsPerSecond)};
    // clock_nanosleep returns its error instead of setting errno. It is called again only if a signal interrupted it.
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &ts, nullptr) == EINTR) {
    }
  }
  Nanoseconds now = monotonicNow();
  while (now < deadline) now = monotonicNow();
  return now;
}

}  // namespace hapticd
