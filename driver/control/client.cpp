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
    return Error{"no daemon answers at " + file + ": " +
                 (errno == EAGAIN ? "it is busy, and so is its queue" : std::strerror(errno)) +
                 "\n  fix: start one with hapticd run, or name it with --name; its group may talk to it, no one else"};
  return Client(file, fd);
}

Client::~Client() {
  if (fd_ >= 0) close(fd_);
}

Result<std::string> Client::ask(const std::string& line, double seconds) {
  const std::string out = line + "\n";
  size_t sent = 0;
  while (sent < out.size()) {
    const ssize_t now = send(fd_, out.data() + sent, out.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno == EAGAIN) return Error{"the daemon at " + file_ + " takes no request"};
    if (now <= 0) break;
    sent += static_cast<size_t>(now);
  }
  std::string answer;
  char buffer[4096];
  pollfd polled{fd_, POLLIN, 0};
  while (answer.find('\n') == std::string::npos && poll(&polled, 1, static_cast<int>(seconds * 1e3)) == 1) {
    const ssize_t got = recv(fd_, buffer, sizeof buffer, 0);
    if (got <= 0) break;
    answer.append(buffer, static_cast<size_t>(got));
  }
  const size_t end = answer.find('\n');
  if (end == std::string::npos) return Error{"the daemon at " + file_ + " did not answer"};
  return answer.substr(0, end);
}

Result<std::string> ask(const std::string& file, const std::string& line, double seconds) {
  auto client = Client::connect(file);
  if (!client) return Error{client.error()};
  return client->ask(line, seconds);
}

}  // namespace hapticd::control
