// SPDX-License-Identifier: MIT
/// Messages to the service manager, also for its watchdog: systemd's notification protocol over NOTIFY_SOCKET, without
/// systemd's library.
#pragma once
#include <optional>
#include <string>

#include "base/clock.hpp"

namespace hapticd::watch {

/// [any] Sends a message such as "READY=1". Returns false if no service manager asked for messages, or if sending
/// failed.
bool notify(const std::string& message);

/// [main] Returns the period within which the service manager expects the next message that all is well (WATCHDOG_USEC,
/// if it is meant for this process); nothing if it expects no such messages.
std::optional<Nanoseconds> watchdogPeriod();

/// Sends the message that all is well to the service manager, but only while the servo makes ticks.
class Feeder {
 public:
  Feeder() : period_(watchdogPeriod()) {}

  /// [main] Call it several times a second. @return true if it sent the message
  bool feed(Nanoseconds now, uint64_t ticks);

 private:
  std::optional<Nanoseconds> period_;
  Nanoseconds fed_at_ = 0;
  uint64_t fed_ticks_ = 0;
};

}  // namespace hapticd::watch
