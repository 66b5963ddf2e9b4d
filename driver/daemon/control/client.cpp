// SPDX-License-Identifier: MIT
#include "control/client.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hapticd::control {

namespace {

constexpr time_t kSendSeconds = 5;

/// A connected socket, or -1.
int connected(const std::string& file) {
  sockaddr_un address{};
  if (!socketAddress(file, address)) return -1;
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const timeval limit{kSendSeconds, 0};  // also of connect(), which waits for room in the queue of a busy server
  if (fd >= 0) setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  if (fd >= 0 && connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  const int code = errno;
  if (fd >= 0) close(fd);
  errno = code;
  return -1;
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
  if (fd < 0)
    return Error{
        "no daemon answers at " + file + ": " +
        (errno == EAGAIN ? "the daemon is busy, and its queue is full" : std::strerror(errno)) +
        "\n  fix: start one with hapticd run, or name a running one with --name; only its user and group may connect"};
  return Client(file, fd);
}

/// The kernel says so as soon as the other end is closed, however its process ended.
bool Client::ended() const {
  pollfd socket{fd_, 0, 0};
  return poll(&socket, 1, 0) > 0 && (socket.revents & (POLLHUP | POLLERR)) != 0;
}

Client::~Client() {
  if (fd_ >= 0) close(fd_);
}

Result<void> Client::say(const std::string& line, std::span<const int> descriptors) {
  const std::string out = line + "\n";
  for (size_t sent = 0; sent < out.size();) {
    const ssize_t now =
        sendWith(fd_, std::string_view(out).substr(sent), sent == 0 ? descriptors : std::span<const int>());
    if (now < 0 && errno == EAGAIN) return Error{"the daemon at " + file_ + " accepts no request"};
    if (now <= 0) break;
    sent += static_cast<size_t>(now);
  }
  return {};
}

Result<Reply> Client::receive(double seconds) {
  Reply reply;
  pollfd polled{fd_, POLLIN, 0};
  std::vector<Descriptor> descriptors;
  while (heard_.find('\n') == std::string::npos && poll(&polled, 1, static_cast<int>(seconds * 1e3)) == 1) {
    char buffer[4096];
    const ssize_t got = receiveWith(fd_, buffer, descriptors);
    if (got <= 0) break;
    heard_.append(buffer, static_cast<size_t>(got));
  }
  if (!descriptors.empty()) reply.descriptor = std::move(descriptors.front());
  const size_t end = heard_.find('\n');
  if (end == std::string::npos) return Error{"the daemon at " + file_ + " did not answer"};
  reply.line = heard_.substr(0, end);
  heard_.erase(0, end + 1);
  return reply;
}

Result<Reply> Client::askForMore(const std::string& line, double seconds) {
  if (auto said = say(line); !said) return Error{said.error()};
  return receive(seconds);
}

Result<std::string> Client::ask(const std::string& line, double seconds) {
  auto reply = askForMore(line, seconds);
  if (!reply) return Error{reply.error()};
  return std::move(reply->line);
}

Result<std::string> Client::askWith(const std::string& line, std::span<const int> descriptors, double seconds) {
  if (auto said = say(line, descriptors); !said) return Error{said.error()};
  return hear(seconds);
}

Result<std::string> Client::hear(double seconds) {
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
