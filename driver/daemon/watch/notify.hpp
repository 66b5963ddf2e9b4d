// SPDX-License-Identifier: MIT
/// The service manager's side of the watchdog: systemd's notification protocol over NOTIFY_SOCKET, without its library.
#pragma once
#include <optional>
#include <string>

#include "base/clock.hpp"

namespace hapticd::watch {

/// [any] Sends a message such as "READY=1". False if nobody asked for it, or it could not be sent.
bool notify(const std::string& message);

/// [main] How often the service manager wants to hear that all is well (WATCHDOG_USEC, for this process); nothing if it
/// does not ask.
std::optional<Nanoseconds> watchdogPeriod();

/// Feeds the service manager's watchdog, but only while the servo ticks.
class Feeder {
 public:
  Feeder() : period_(watchdogPeriod()) {}

  /// [main] Call several times a second. @return true when it fed
  bool feed(Nanoseconds now, uint64_t ticks);

 private:
  std::optional<Nanoseconds> period_;
  Nanoseconds fed_at_ = 0;
  uint64_t fed_ticks_ = 0;
};

}  // namespace hapticd::watch
