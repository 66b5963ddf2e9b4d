// SPDX-License-Identifier: MIT
#include "watch/notify.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace hapticd::watch {

bool notify(const std::string& message) {
  const char* path = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path == nullptr || (path[0] != '/' && path[0] != '@') || std::strlen(path) >= sizeof address.sun_path)
    return false;
  std::strcpy(address.sun_path, path);
  if (path[0] == '@') address.sun_path[0] = '\0';  // @ stands for a zero byte: the abstract name space
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(path));
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return false;
  const ssize_t sent =
      sendto(fd, message.data(), message.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address), length);
  close(fd);
  return sent == static_cast<ssize_t>(message.size());
}

std::optional<Nanoseconds> watchdogPeriod() {
  const char *period = std::getenv("WATCHDOG_USEC"), *pid = std::getenv("WATCHDOG_PID");
  if (period == nullptr) return std::nullopt;
  if (pid != nullptr && std::strtol(pid, nullptr, 10) != getpid()) return std::nullopt;
  const unsigned long long us = std::strtoull(period, nullptr, 10);
  if (us == 0) return std::nullopt;
  return us * 1000;
}

bool Feeder::feed(Nanoseconds now, uint64_t ticks) {
  if (!period_ || ticks == fed_ticks_ || now - fed_at_ < *period_ / 4) return false;
  fed_at_ = now;
  fed_ticks_ = ticks;
  return notify("WATCHDOG=1");
}

}  // namespace hapticd::watch
