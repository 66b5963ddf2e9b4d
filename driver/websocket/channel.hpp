// SPDX-License-Identifier: MIT
/// A WebSocket of one thread, which waits for each message, and a port that takes such.
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
  /// [any] Only one thread. Waits until the message is on its way.
  virtual Result<void> send(std::string_view text, int timeout_ms) = 0;
  /// [any] The same thread. Waits for the next message.
  virtual Result<std::string> receive(int timeout_ms) = 0;
};

/// A port of the loopback interface.
class Listener {
 public:
  virtual ~Listener() = default;
  /// [main] Binds 127.0.0.1. @param port 0: one that is free
  static Result<std::unique_ptr<Listener>> listen(unsigned short port);
  virtual unsigned short port() const = 0;
  /// [any] One thread. The next who asks for a WebSocket; nullptr: nobody came in this time, or it was refused. A page
  /// of a browser is refused unless this machine serves it: any page of the world could connect otherwise.
  virtual std::unique_ptr<Channel> accept(int timeout_ms) = 0;
};

}  // namespace hapticd::websocket
