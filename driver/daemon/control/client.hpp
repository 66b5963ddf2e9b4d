// SPDX-License-Identifier: MIT
/// The client's side of the control socket, for `hapticd ctl` and tests.
#pragma once
#include <sys/un.h>

#include <deque>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "control/server.hpp"

namespace hapticd::control {

/// [any] Fills in the address of a socket. Returns false if the path is too long for a socket.
bool socketAddress(const std::string& file, sockaddr_un& address);

/// [main] True if a process accepts connections at the socket.
bool connectTo(const std::string& file);

/// A connection for many requests. If a request timed out and its answer comes late, this answer is not taken for the
/// answer to a later request. Nor are news, which are lines that the daemon sends without a request.
class Client {
 public:
  static constexpr size_t kMostNews =
      4096;  ///< most lines that are kept for receiveLine(); if more come, the oldest are dropped

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

  /// [main] Sends one line and waits for its answer. @param seconds longest time to wait
  Result<std::string> ask(const std::string& line, double seconds = 10);
  /// [main] Like ask(), but sends descriptors with the line; they stay open in this process.
  Result<std::string> askWith(const std::string& line, std::span<const int> descriptors, double seconds = 10);
  /// [main] Like askWith(), but waits until the answer comes or the daemon ends, and calls `waits` every 10 s.
  Result<std::string> askPatiently(const std::string& line, std::span<const int> descriptors,
                                   const std::function<void()>& waits);
  /// [main] Like ask(), but also returns the descriptor that came with the answer.
  Result<Reply> askForMore(const std::string& line, double seconds = 10);
  /// [main] Sends one line without waiting for its answer.
  void leave(const std::string& line);
  /// [main] Returns the next line that the daemon sends by itself (news); an error if none comes in time.
  /// @param seconds longest time to wait
  Result<std::string> receiveLine(double seconds);
  /// [any] True if the daemon has ended, or has closed this connection.
  bool ended() const;

 private:
  Client(std::string file, int fd) : file_(std::move(file)), fd_(fd) {}
  Result<void> sendLine(const std::string& line, std::span<const int> descriptors = {});
  Result<Reply> answer(double seconds);
  Result<Reply> receive(double seconds);
  bool receiveMore();
  void take(std::string_view bytes, std::vector<Descriptor> with);
  std::string file_;
  int fd_;
  Reply begun_;              ///< the part of a line that has come so far
  std::deque<Reply> lines_;  ///< received lines that no function has returned yet
  std::deque<Reply> news_;   ///< news that came while ask() waited for an answer
  size_t owed_ = 0;          ///< number of answers that have not come yet
};

/// [main] Sends one request on a new connection, and returns the answer. @param seconds longest time to wait
Result<std::string> ask(const std::string& file, const std::string& line, double seconds = 10);

}  // namespace hapticd::control
