// SPDX-License-Identifier: MIT
/// The other end of the control socket: `hapticd ctl` and tests.
#pragma once
#include <sys/un.h>

#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "control/server.hpp"

namespace hapticd::control {

/// [any] False: the path is too long for a socket.
bool socketAddress(const std::string& file, sockaddr_un& address);

/// [main] True if somebody serves the socket.
bool connectTo(const std::string& file);

/// A connection for many requests. An answer that comes after its request was given up, and what comes by itself, is
/// taken for no other request's answer.
class Client {
 public:
  static constexpr size_t kMostNews = 4096;  ///< lines that are kept for hear(); then the oldest go

  /// [main] @param file the socket of a running daemon
  static Result<Client> connect(const std::string& file);
  Client(Client&& other) noexcept
      : file_(std::move(other.file_)),
        fd_(std::exchange(other.fd_, -1)),
        begun_(std::move(other.begun_)),
        lines_(std::move(other.lines_)),
        news_(std::move(other.news_)),
        owed_(other.owed_) {}
  Client& operator=(Client&&) = delete;
  ~Client();

  /// [main] Sends one line and waits for its answer. @param seconds at most
  Result<std::string> ask(const std::string& line, double seconds = 10);
  /// [main] The same, with descriptors that go along with the line; they stay open here.
  Result<std::string> askWith(const std::string& line, std::span<const int> descriptors, double seconds = 10);
  /// [main] The same, with the descriptor that came along.
  Result<Reply> askForMore(const std::string& line, double seconds = 10);
  /// [main] Sends one line whose answer nobody waits for.
  void leave(const std::string& line);
  /// [main] The next line that comes by itself. @param seconds at most; an error where none came
  Result<std::string> hear(double seconds);
  /// [any] The daemon has ended, or it ended this connection.
  bool ended() const;

 private:
  Client(std::string file, int fd) : file_(std::move(file)), fd_(fd) {}
  Result<void> say(const std::string& line, std::span<const int> descriptors = {});
  Result<Reply> answer(double seconds);
  Result<Reply> receive(double seconds);
  bool receiveMore();
  void take(std::string_view bytes, std::vector<Descriptor> with);
  std::string file_;
  int fd_;
  Reply begun_;              ///< a line whose end has not come yet
  std::deque<Reply> lines_;  ///< not given out yet
  std::deque<Reply> news_;   ///< came by themselves while an answer was waited for
  size_t owed_ = 0;          ///< answers that have not come yet
};

/// [main] One request on a connection of its own. @param seconds at most
Result<std::string> ask(const std::string& file, const std::string& line, double seconds = 10);

}  // namespace hapticd::control
