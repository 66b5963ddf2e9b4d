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

/// A connection for many requests. An answer whose request was given up, and lines that come unasked, are never taken
/// for the answer to another request.
class Client {
 public:
  static constexpr size_t kMostNews = 4096;  ///< lines that are kept for hear(); beyond that the oldest are dropped

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
  /// [main] The same, with descriptors that are sent with the line; they stay open here.
  Result<std::string> askWith(const std::string& line, std::span<const int> descriptors, double seconds = 10);
  /// [main] The same, and gives the descriptor that came with the answer.
  Result<Reply> askForMore(const std::string& line, double seconds = 10);
  /// [main] Sends one line whose answer nobody waits for.
  void leave(const std::string& line);
  /// [main] The next line that comes unasked. @param seconds to wait at most; it is an error if none came
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
  std::deque<Reply> news_;   ///< lines that came unasked while an answer was waited for
  size_t owed_ = 0;          ///< how many answers have not come yet
};

/// [main] One request on a connection of its own. @param seconds at most
Result<std::string> ask(const std::string& file, const std::string& line, double seconds = 10);

}  // namespace hapticd::control
