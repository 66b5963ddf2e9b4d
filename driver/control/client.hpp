/// The other end of the control socket: `hapticd ctl` and tests.
#pragma once
#include <sys/un.h>

#include <string>
#include <utility>

#include "base/result.hpp"

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
  Client(Client&& other) noexcept : file_(std::move(other.file_)), fd_(std::exchange(other.fd_, -1)) {}
  Client& operator=(Client&&) = delete;
  ~Client();

  /// [main] Sends one line and waits for its answer. @param seconds at most
  Result<std::string> ask(const std::string& line, double seconds = 10);

 private:
  Client(std::string file, int fd) : file_(std::move(file)), fd_(fd) {}
  std::string file_;
  int fd_;
};

/// [main] One request on a connection of its own. @param seconds at most
Result<std::string> ask(const std::string& file, const std::string& line, double seconds = 10);

}  // namespace hapticd::control
