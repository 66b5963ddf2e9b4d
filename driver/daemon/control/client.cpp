// SPDX-License-Identifier: MIT
#include "control/client.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/clock.hpp"
#include "control/liveness.hpp"

namespace hapticd::control {

namespace {

constexpr time_t kSendSeconds = 5;
constexpr const char* kBusy =
    "\n  it may be setting up a model: its log says what it waits for; hapticd top shows whether its servo runs";

/// Returns a connected socket, or -1 with errno.
int connected(const std::string& file) {
  sockaddr_un address{};
  if (!socketAddress(file, address)) return -1;
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval limit{kSendSeconds, 0};  // bounds connect() too, which waits for room in the queue of a busy server
  if (fd >= 0) setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  if (fd >= 0 && connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  const int code = errno;
  if (fd >= 0) close(fd);
  errno = code;
  return -1;
}

/// Says why a daemon has closed a connection without an answer. One that ends may live on for a moment.
std::string closedText(const std::string& file) {
  constexpr double kEnding = 1;  // s
  if (waitForEnd(file, kEnding)) return "the daemon at " + file + " has ended without an answer";
  return "the daemon at " + file +
         " closed the connection without an answer, but runs on: it may serve too many programs"
         "\n  fix: end some of them, or try again";
}

}  // namespace

bool socketAddress(const std::string& file, sockaddr_un& address) {
  address.sun_family = AF_UNIX;
  if (file.size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return false;
  }
  std::memcpy(address.sun_path, file.c_str(), file.size() + 1);
  return true;
}

bool connectTo(const std::string& file) {
  const int fd = connected(file);
  if (fd >= 0) close(fd);
  return fd >= 0;
}

Result<Client> Client::connect(const std::string& file) {
  const int fd = connected(file);
  if (fd >= 0) return Client(file, fd);
  const int code = errno;
  const bool none = (code == ENOENT || code == ECONNREFUSED) && !isAlive(file);
  const std::string said = none ? noDaemonText(file) : "";
  errno = code;  // libHD.so reports it to its program
  if (none) return Error{said};
  const std::string why = code == EAGAIN ? "the daemon is busy, and its queue is full" : std::strerror(code);
  return Error{"no daemon answers at " + file + ": " + why + "\n  fix: " +
               (code == EACCES ? "only the daemon's user and group may connect: be one of them" : "try again")};
}

/// The kernel reports the end of the connection as soon as the daemon's end is closed, even if the daemon was killed.
bool Client::ended() const {
  pollfd socket{fd_, 0, 0};
  return poll(&socket, 1, 0) > 0 && (socket.revents & (POLLHUP | POLLERR)) != 0;
}

Client::~Client() {
  if (fd_ >= 0) close(fd_);
}

Result<void> Client::sendLine(const std::string& line, std::span<const int> descriptors) {
  const std::string out = line + "\n";
  for (size_t sent = 0; sent < out.size();) {
    const ssize_t now =
        sendWith(fd_, std::string_view(out).substr(sent), sent == 0 ? descriptors : std::span<const int>());
    if (now < 0 && errno == EINTR) continue;
    if (now < 0 && errno == EAGAIN)
      return Error{"the daemon at " + file_ + " does not take requests: it reads nothing from its socket"};
    if (now <= 0) break;
    sent += static_cast<size_t>(now);
  }
  ++owed_;
  return {};
}

/// The daemon sends a descriptor with the first byte of its line, and the kernel delivers no byte of the next message
/// with it, so the descriptor belongs to the last line that begins in the received bytes.
void Client::take(std::string_view bytes, std::vector<Descriptor> with) {
  while (!bytes.empty()) {
    const size_t end = bytes.find('\n');
    const bool last = end == std::string_view::npos || end + 1 == bytes.size();
    begun_.line.append(bytes.substr(0, end));
    if (last && !with.empty()) begun_.descriptor = std::move(with.front());
    if (end == std::string_view::npos) return;
    lines_.push_back(std::exchange(begun_, Reply()));
    bytes.remove_prefix(end + 1);
  }
}

/// Waits for more bytes. @return false if the connection has ended, or what comes is no line
bool Client::receiveMore() {
  constexpr size_t kMostLine = 64u << 20;  // [bytes] no answer is longer

  char buffer[4096];
  std::vector<Descriptor> with;
  const ssize_t got = receiveWith(fd_, buffer, with);
  if (got > 0) take({buffer, static_cast<size_t>(got)}, std::move(with));
  if (begun_.line.size() > kMostLine) return false;
  return got > 0 || (got < 0 && errno == EINTR);
}

/// Returns the next line, which is an answer or an event.
Result<Reply> Client::receive(double seconds) {
  const Nanoseconds end = monotonicNow() + static_cast<Nanoseconds>(seconds * 1e9);
  while (lines_.empty()) {
    const Nanoseconds left = std::max<Nanoseconds>(end - monotonicNow(), 0);
    pollfd polled{fd_, POLLIN, 0};
    const int ready = poll(&polled, 1, static_cast<int>((left + 999'999) / 1'000'000));
    if (ready < 0 && errno == EINTR) continue;  // a signal handler of the program interrupted the call
    if (ready != 1) return Error{"the daemon at " + file_ + " did not answer in time" + kBusy};
    if (!receiveMore()) return Error{closedText(file_)};
  }
  Reply reply = std::move(lines_.front());
  lines_.pop_front();
  return reply;
}

/// Returns the answer to the last request. Answers to earlier requests that timed out come first, and are dropped.
Result<Reply> Client::answer(double seconds) {
  constexpr std::string_view kNews = R"({"event":)";
  const Nanoseconds end = monotonicNow() + static_cast<Nanoseconds>(seconds * 1e9);
  for (;;) {
    auto reply = receive(static_cast<double>(end - monotonicNow()) * 1e-9);
    if (!reply) return reply;
    if (reply->line.compare(0, kNews.size(), kNews) != 0) {
      owed_ -= std::min<size_t>(owed_, 1);
      if (owed_ == 0) return reply;
    } else {
      news_.push_back(std::move(*reply));
      if (news_.size() > kMostNews) news_.pop_front();
    }
    if (monotonicNow() > end) return Error{"the daemon at " + file_ + " did not answer in time" + kBusy};
  }
}

Result<Reply> Client::askForMore(const std::string& line, double seconds) {
  if (auto said = sendLine(line); !said) return Error{said.error()};
  return answer(seconds);
}

void Client::leave(const std::string& line) {
  (void)sendLine(line);
}

Result<std::string> Client::ask(const std::string& line, double seconds) {
  return askWith(line, {}, seconds);
}

Result<std::string> Client::askWith(const std::string& line, std::span<const int> descriptors, double seconds) {
  if (auto said = sendLine(line, descriptors); !said) return Error{said.error()};
  auto reply = answer(seconds);
  if (!reply) return Error{reply.error()};
  return std::move(reply->line);
}

Result<std::string> Client::askPatiently(const std::string& line, std::span<const int> descriptors,
                                         const std::function<void()>& waits) {
  constexpr double kEvery = 10;  // [s]
  if (auto said = sendLine(line, descriptors); !said) return Error{said.error()};
  for (;;) {
    auto reply = answer(kEvery);
    if (reply) return std::move(reply->line);
    if (ended()) return Error{reply.error()};
    waits();
  }
}

Result<std::string> Client::receiveLine(double seconds) {
  if (!news_.empty()) {
    Reply first = std::move(news_.front());
    news_.pop_front();
    return std::move(first.line);
  }
  auto reply = receive(seconds);
  if (!reply) return Error{reply.error()};
  return std::move(reply->line);
}

Result<std::string> ask(const std::string& file, const std::string& line, double seconds) {
  auto client = Client::connect(file);
  if (!client) return Error{client.error()};
  return client->ask(line, seconds);
}

}  // namespace hapticd::control
