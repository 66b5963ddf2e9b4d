// SPDX-License-Identifier: MIT
/// The client that sends a request over the control socket, and the reply to it.
#pragma once
#include <sys/types.h>

#include <string>
#include <utility>

#include "base/clock.hpp"
#include "base/descriptors.hpp"

namespace hapticd::control {

/// The client that sends a request. Each connection has its own `id`, which is never used again.
struct Peer {
  uint64_t id = 0;
  pid_t pid = 0;  ///< process that connected
  uid_t uid = 0;
  Nanoseconds asked = 0;  ///< CLOCK_MONOTONIC when the work on the request began
};

/// One line without its end, and perhaps a descriptor that is sent together with the line.
struct Reply {
  Reply() = default;
  Reply(std::string text) : line(std::move(text)) {}  // NOLINT: implicit by intent
  Reply(std::string text, Descriptor attached) : line(std::move(text)), descriptor(std::move(attached)) {}
  std::string line;
  Descriptor descriptor;
};

/// Why the daemon keeps a connection open even if it receives no requests on it.
struct KeepAlive {
  bool stays = false;    ///< something depends on the connection, so it may be silent for any time
  bool listens = false;  ///< the client subscribed to news
};

}  // namespace hapticd::control
