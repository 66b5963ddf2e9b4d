// SPDX-License-Identifier: MIT
/// A WebSocket connection for use by one thread, whose calls wait for each message, and a port that accepts such
/// connections.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "base/result.hpp"

namespace hapticd::websocket {

/// One connection; text messages of 64 KiB at most. After an error it can no longer be used.
class Channel {
 public:
  virtual ~Channel() = default;  ///< closes the connection at once
  /// [main] Connects to ws://HOST:PORT/.
  static Result<std::unique_ptr<Channel>> connect(const std::string& host, unsigned short port, int timeout_ms);
  /// [any] Called from one thread only. Waits until the message has been passed to the system.
  virtual Result<void> send(std::string_view text, int timeout_ms) = 0;
  /// [any] Called from the same thread. Waits for the next message.
  virtual Result<std::string> receive(int timeout_ms) = 0;
};

/// A port of the loopback interface.
class Listener {
 public:
  virtual ~Listener() = default;
  /// [main] Binds 127.0.0.1. @param port 0 takes any free port
  static Result<std::unique_ptr<Listener>> listen(unsigned short port);
  virtual unsigned short port() const = 0;
  /// [any] Called from one thread only. Waits for the next connection, for at most `timeout_ms` [ms]. Returns nullptr
  /// if none came or if the connection was refused. A browser is refused unless its page comes from this machine;
  /// otherwise any page on the web could connect.
  virtual std::unique_ptr<Channel> accept(int timeout_ms) = 0;
};

}  // namespace hapticd::websocket
