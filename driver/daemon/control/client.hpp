// SPDX-License-Identifier: MIT
/// The other end of the control socket: `hapticd ctl` and tests.
#pragma once
#include <sys/un.h>

#include <string>
#include <utility>

#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "control/server.hpp"

namespace hapticd::control {

/// [any] False: the path is too long for a socket.
bool socketAddress(const std::string& file, sockaddr_un& address);

/// [main] True if somebody serves the socket.
bool connectTo(const std::string& file);

/// A connection for many requests.
class Client {
 public:
  /// [main] @param file the socket of a running daemon
  static Result<Client> connect(const std::string& file);
  Client(Client&& other) noexcept
      : file_(std::move(other.file_)), fd_(std::exchange(other.fd_, -1)), heard_(std::move(other.heard_)) {}
  Client& operator=(Client&&) = delete;
  ~Client();

  /// [main] Sends one line and waits for its answer. @param seconds at most
  Result<std::string> ask(const std::string& line, double seconds = 10);
  /// [main] The same, with descriptors that go along with the line; they stay open here.
  Result<std::string> askWith(const std::string& line, std::span<const int> descriptors, double seconds = 10);
  /// [main] The same, with the descriptor that came along.
  Result<Reply> askForMore(const std::string& line, double seconds = 10);
  /// [main] The next line that comes by itself. @param seconds at most; an error where none came
  Result<std::string> hear(double seconds);
  /// [any] The daemon has ended, or it ended this connection.
  bool ended() const;

 private:
  Client(std::string file, int fd) : file_(std::move(file)), fd_(fd) {}
  Result<void> say(const std::string& line, std::span<const int> descriptors = {});
  Result<Reply> receive(double seconds);
  std::string file_;
  int fd_;
  std::string heard_;  ///< bytes behind the last line that was given out
};

/// [main] One request on a connection of its own. @param seconds at most
Result<std::string> ask(const std::string& file, const std::string& line, double seconds = 10);

}  // namespace hapticd::control
