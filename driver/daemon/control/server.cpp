// SPDX-License-Identifier: MIT
#include "control/server.hpp"

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "control/client.hpp"
#include "control/request.hpp"

namespace hapticd::control {

namespace {

constexpr int kPollMs = 500;
constexpr Nanoseconds kAcceptPause = 500'000'000;  ///< after a failure, as without a free descriptor
constexpr int kReadsATurn = 4;                     ///< so that no client keeps the others waiting

Error cannot(const std::string& file, const std::string& what) {
  return Error{"cannot serve " + file + ": " + what + "\n  no other program can watch or change this run"};
}

}  // namespace

Result<std::unique_ptr<Server>> Server::listen(const std::string& file, const std::string& group) {
  sockaddr_un address{};
  if (!socketAddress(file, address)) return cannot(file, "the path is too long for a socket");
  if (connectTo(file)) return cannot(file, "another daemon serves it\n  fix: hapticd run --name OTHER");
  struct stat old{};
  if (lstat(file.c_str(), &old) == 0 && !S_ISSOCK(old.st_mode)) return cannot(file, "it is not a socket");
  unlink(file.c_str());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  int wake[2] = {-1, -1};
  const mode_t mask = umask(0177);  // nobody else may connect before its group is set
  const bool bound = fd >= 0 && bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  umask(mask);
  constexpr int kBacklog = 16;
  const bool listens = bound && ::listen(fd, kBacklog) == 0 && pipe2(wake, O_CLOEXEC | O_NONBLOCK) == 0;
  const int code = errno;
  if (!listens) {
    if (fd >= 0) close(fd);
    return cannot(file, std::strerror(code));
  }
  const struct group* found = group.empty() ? nullptr : getgrnam(group.c_str());
  const gid_t owner = found != nullptr ? found->gr_gid : getegid();
  if (chown(file.c_str(), static_cast<uid_t>(-1), owner) == 0) chmod(file.c_str(), 0660);
  return std::unique_ptr<Server>(new Server(file, fd, wake[0], wake[1]));
}

Server::~Server() {
  stop();
  for (const Client& client : clients_) close(client.fd);
  for (const int fd : {fd_, wake_[0], wake_[1]}) close(fd);
  unlink(file_.c_str());
}

std::error_code Server::start(Service service) {
  service_ = std::move(service);
  return thread_.start("hapticd-control", [this] { serve(); });
}

void Server::stop() {
  stop_.store(true, std::memory_order_relaxed);
  const char byte = 0;
  [[maybe_unused]] const ssize_t woken = write(wake_[1], &byte, 1);
  thread_.join();
}

void Server::serve() {
  std::vector<pollfd> polled;
  while (!stop_.load(std::memory_order_relaxed)) {
    polled.assign({{fd_, static_cast<short>(maySeat(monotonicNow()) ? POLLIN : 0), 0}, {wake_[0], POLLIN, 0}});
    for (const Client& client : clients_) {
      // one that does not read its answers is not asked for more
      const bool reads = client.out.empty() && !client.closing;
      polled.push_back({client.fd, static_cast<short>(reads ? POLLIN : POLLOUT), 0});
    }
    poll(polled.data(), polled.size(), listened() ? static_cast<int>(kNewsPeriod / 1'000'000) : kPollMs);
    const Nanoseconds now = monotonicNow();
    const size_t known = clients_.size();
    for (size_t i = 0; i < known; ++i) watch(clients_[i], polled[i + 2].revents, now);
    if (now >= news_due_) news_due_ = now + kNewsPeriod;
    std::erase_if(clients_, [](const Client& client) { return client.fd < 0; });
    if ((polled[0].revents & POLLIN) != 0) accept(now);
  }
}

bool Server::listened() const {
  return std::any_of(clients_.begin(), clients_.end(), [](const Client& c) { return c.standing.listens; });
}

/// One turn of one client.
void Server::watch(Client& client, short events, Nanoseconds now) {
  bool good = (events & (POLLERR | POLLNVAL)) == 0;
  if (events != 0) client.heard = now;
  if (good && (events & (POLLIN | POLLHUP)) != 0 && client.out.empty()) good = receive(client);
  if (good && client.standing.listens && client.out.empty() && now >= news_due_) tellNews(client);
  if (good && !client.out.empty()) good = send(client);
  if (!good || !patient(client, now) || (client.closing && client.out.empty())) end(client);
}

void Server::end(Client& client) {
  close(client.fd);
  client.fd = -1;
  if (service_.left) service_.left(client.peer);
}

/// It has been idle for long enough to make room for another.
bool Server::mayYield(const Client& client, Nanoseconds now) const {
  return !client.standing.stays && now - client.heard >= kIdle;
}

/// There is room for one more, or a client that makes room.
bool Server::maySeat(Nanoseconds now) const {
  if (now < accept_after_) return false;
  return clients_.size() < kMaxClients ||
         std::any_of(clients_.begin(), clients_.end(), [&](const Client& c) { return mayYield(c, now); });
}

void Server::accept(Nanoseconds now) {
  const int fd = accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) {
    if (errno != EAGAIN && errno != ECONNABORTED && errno != EINTR) accept_after_ = now + kAcceptPause;
    return;
  }
  if (clients_.size() >= kMaxClients) {
    const auto idle = std::min_element(clients_.begin(), clients_.end(), [](const Client& a, const Client& b) {
      return std::pair(a.standing.stays, a.heard) < std::pair(b.standing.stays, b.heard);
    });
    end(*idle);
    clients_.erase(idle);
  }
  Client& client = clients_.emplace_back();
  client.fd = fd;
  client.heard = now;
  ucred who{};
  socklen_t bytes = sizeof who;
  if (getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &bytes) != 0) who = {};
  client.peer = {++last_id_, who.pid, who.uid};
}

void Server::queue(Client& client, Reply reply) {
  client.waiting += reply.line.size();
  const bool joins = !client.out.empty() && !client.out.back().descriptor && !reply.descriptor;
  if (joins) {
    client.out.back().line += reply.line;  // one system call for many short lines
  } else {
    client.out.push_back(std::move(reply));
  }
}

void Server::tellNews(Client& client) {
  if (!service_.news) return;
  if (std::string lines = service_.news(client.peer); !lines.empty()) queue(client, std::move(lines));
}

bool Server::receive(Client& client) {
  char buffer[4096];
  for (int i = 0; i < kReadsATurn && client.in.size() <= kMaxRequestBytes; ++i) {
    const ssize_t got = recv(client.fd, buffer, sizeof buffer, 0);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) break;
    if (got < 0) return false;
    if (got == 0) {
      if (!client.in.empty() && client.in.back() != '\n') client.in += '\n';  // as from printf, without one
      client.closing = true;
      break;
    }
    client.in.append(buffer, static_cast<size_t>(got));
  }
  answerLines(client);
  return true;
}

void Server::answerLines(Client& client) {
  size_t begin = 0;
  for (size_t end; (end = client.in.find('\n', begin)) != std::string::npos && client.waiting < kMaxWaiting;
       begin = end + 1) {
    Reply reply = service_.answer(client.peer, client.in.substr(begin, end - begin));
    reply.line += '\n';
    queue(client, std::move(reply));
    if (service_.standing) client.standing = service_.standing(client.peer);
  }
  client.in.erase(0, begin);
  if (client.in.size() > kMaxRequestBytes) {
    queue(client, refusal("the request is longer than " + std::to_string(kMaxRequestBytes) + " bytes") + "\n");
    client.in.clear();
    client.closing = true;
  }
}

bool Server::send(Client& client) {
  while (!client.out.empty()) {
    Reply& next = client.out.front();
    const int descriptor = next.descriptor.get();
    const ssize_t sent = sendWith(client.fd, next.line, {&descriptor, next.descriptor ? size_t{1} : size_t{0}});
    if (sent < 0) return errno == EAGAIN;
    next.descriptor = Descriptor();
    next.line.erase(0, static_cast<size_t>(sent));
    client.waiting -= static_cast<size_t>(sent);
    if (next.line.empty()) client.out.pop_front();
  }
  client.since = 0;
  answerLines(client);  // lines that waited for room
  return true;
}

bool Server::patient(Client& client, Nanoseconds now) {
  if (client.in.empty() && client.out.empty())
    client.since = 0;
  else if (client.since == 0)
    client.since = now;
  return client.since == 0 || now - client.since < kPatience;
}

}  // namespace hapticd::control
