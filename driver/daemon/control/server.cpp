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
#include <tuple>
#include <utility>

#include "control/client.hpp"
#include "control/request.hpp"

namespace hapticd::control {

namespace {

constexpr int kPollMs = 500;
constexpr Nanoseconds kAcceptPause = 500'000'000;  ///< [ns] pause after a failure, such as a lack of free descriptors
constexpr int kReadsATurn = 4;                     ///< limit, so that no client keeps the others waiting

Error cannot(const std::string& file, const std::string& what) {
  return Error{"cannot serve " + file + ": " + what + "\n  no other program can watch or change this run"};
}

}  // namespace

Result<std::unique_ptr<Server>> Server::listen(const std::string& file, const std::string& group) {
  const std::string early = file + "~";  // it gets its name when it answers: no program finds a socket that refuses
  sockaddr_un address{};
  if (!socketAddress(early, address)) return cannot(file, "the path is too long for a socket");
  if (connectTo(file)) return cannot(file, "another daemon has this socket\n  fix: hapticd run --name OTHER");
  struct stat old{};
  if (lstat(file.c_str(), &old) == 0 && !S_ISSOCK(old.st_mode))
    return cannot(file, "a file that is not a socket has this name\n  fix: move it away, or hapticd run --name OTHER");
  unlink(early.c_str());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  int wake[2] = {-1, -1};
  const mode_t mask = umask(0177);  // only the owner may connect until the group is set
  const bool bound = fd >= 0 && bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  umask(mask);
  constexpr int kBacklog = 16;
  const struct group* found = group.empty() ? nullptr : getgrnam(group.c_str());
  const gid_t owner = found != nullptr ? found->gr_gid : getegid();
  if (bound && chown(early.c_str(), static_cast<uid_t>(-1), owner) == 0) chmod(early.c_str(), 0660);
  const bool listens = bound && pipe2(wake, O_CLOEXEC | O_NONBLOCK) == 0 && ::listen(fd, kBacklog) == 0 &&
                       rename(early.c_str(), file.c_str()) == 0;
  if (!listens) {
    const int code = errno;
    for (const int open : {fd, wake[0], wake[1]})
      if (open >= 0) close(open);
    if (bound) unlink(early.c_str());
    return cannot(file, std::strerror(code));
  }
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
  if (const auto code =
          worker_.start([this](Job& job, JobResult& done) { return work(job, done); }, [this] { wake(); }))
    return code;
  return thread_.start("hapticd-control", [this] { serve(); });
}

void Server::stop() {
  stop_.store(true, std::memory_order_relaxed);
  wake();
  thread_.join();
  worker_.stop();
}

void Server::wake() {
  const char byte = 0;
  [[maybe_unused]] const ssize_t woken = write(wake_[1], &byte, 1);  // a full pipe also wakes the thread up
}

void Server::serve() {
  std::vector<pollfd> polled;
  while (!stop_.load(std::memory_order_relaxed)) {
    const bool accepts = monotonicNow() >= accept_after_;
    polled.assign({{fd_, static_cast<short>(accepts ? POLLIN : 0), 0}, {wake_[0], POLLIN, 0}});
    for (const Client& client : clients_) {
      // no more requests are read from a client that does not read its answers
      const bool reads = client.out.empty() && !client.closing && client.in.size() <= kMaxRequestBytes;
      const int events = client.out.empty() ? (reads ? POLLIN : 0) : POLLOUT;
      polled.push_back({client.hung ? -1 : client.fd, static_cast<short>(events), 0});
    }
    poll(polled.data(), polled.size(), listened() ? static_cast<int>(kNewsPeriod / 1'000'000) : kPollMs);
    const Nanoseconds now = monotonicNow();
    char bytes[64];
    while (read(wake_[0], bytes, sizeof bytes) > 0) {
    }
    size_t i = 2;
    takeDone();
    for (Client& client : clients_) watch(client, polled[i++].revents, now);
    if (now >= news_due_) news_due_ = now + kNewsPeriod;
    clients_.remove_if([](const Client& client) { return client.fd < 0; });
    admitWaiting(now);
    if ((polled[0].revents & POLLIN) != 0) accept(now);
  }
}

bool Server::listened() const {
  return std::any_of(clients_.begin(), clients_.end(), [](const Client& c) { return c.keep_alive.listens; });
}

/// True if an answer to the client is still to be made or sent.
bool Server::hasPendingReply(const Client& client) const {
  return client.asked || !client.out.empty() || client.in.find('\n') != std::string::npos;
}

/// Reads, answers and sends what is possible now for one client.
void Server::watch(Client& client, short events, Nanoseconds now) {
  bool good = (events & (POLLERR | POLLNVAL)) == 0;
  if (events != 0) client.heard = now;
  if (good && (events & (POLLIN | POLLHUP)) != 0 && client.out.empty()) good = receive(client);
  client.hung |= (events & POLLHUP) != 0;
  if (good && client.hung) answerLines(client);
  if (good && client.keep_alive.listens && !client.listening && client.out.empty() && now >= news_due_) {
    client.listening = true;
    worker_.post({Job::Kind::kNews, client.peer, ""});
  }
  if (good && !client.out.empty()) good = send(client);
  if (!good || !patient(client, now) || (client.closing && !hasPendingReply(client))) end(client);
}

void Server::end(Client& client) {
  close(client.fd);
  client.fd = -1;
  if (client.known) worker_.post({Job::Kind::kLeft, client.peer, ""});
}

/// True if the client has been idle for long enough to make room for another.
bool Server::mayBeDropped(const Client& client, Nanoseconds now) const {
  return client.seated && !client.keep_alive.stays && !client.asked && now - client.heard >= kIdle;
}

size_t Server::count(bool seated) const {
  return static_cast<size_t>(
      std::count_if(clients_.begin(), clients_.end(), [&](const Client& c) { return c.seated == seated; }));
}

/// Gives places to clients that wait: places of clients that left, or of clients that have been idle for long.
void Server::admitWaiting(Nanoseconds now) {
  for (Client& client : clients_) {
    if (client.seated) continue;
    if (count(true) >= kMaxClients) {
      const bool yields =
          std::any_of(clients_.begin(), clients_.end(), [&](const Client& c) { return mayBeDropped(c, now); });
      if (!yields) return;
      makeRoom(true);
    }
    client.seated = true;
    answerLines(client);
  }
}

/// Ends the connection of one of the clients that have a place (`seated`) or that wait for one (not `seated`). Prefers
/// one that may not stay silent (KeepAlive::stays), then one without a request in work, then the longest silent one.
void Server::makeRoom(bool seated) {
  const auto rank = [&](const Client& c) {
    return std::tuple(c.seated != seated || c.fd < 0, c.keep_alive.stays, c.asked, c.heard);
  };
  const auto idle = std::min_element(clients_.begin(), clients_.end(),
                                     [&](const Client& a, const Client& b) { return rank(a) < rank(b); });
  end(*idle);
  clients_.erase(idle);
}

void Server::accept(Nanoseconds now) {
  const int fd = accept4(fd_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd < 0) {
    if (errno != EAGAIN && errno != ECONNABORTED && errno != EINTR) accept_after_ = now + kAcceptPause;
    return;
  }
  if (count(false) >= kMaxStanding) makeRoom(false);
  Client& client = clients_.emplace_back();
  client.fd = fd;
  client.heard = now;
  client.seated = false;
  ucred who{};
  socklen_t bytes = sizeof who;
  if (getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &bytes) != 0) who = {};
  client.peer = {++last_id_, who.pid, who.uid, 0};
  admitWaiting(now);
}

void Server::queue(Client& client, Reply reply) {
  client.waiting += reply.line.size();
  const bool joins = !client.out.empty() && !client.out.back().descriptor && !reply.descriptor;
  if (joins) {
    client.out.back().line += reply.line;  // so that one system call sends many short lines
  } else {
    client.out.push_back(std::move(reply));
  }
}

bool Server::receive(Client& client) {
  char buffer[4096];
  for (int i = 0; i < kReadsATurn && client.in.size() <= kMaxRequestBytes; ++i) {
    const ssize_t got = receiveWith(client.fd, buffer, client.given);
    if (given() > kMostDescriptors) return false;  // one program must not take all descriptors of the daemon
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) break;
    if (got < 0) return false;
    if (got == 0) {
      if (!client.in.empty() && client.in.back() != '\n') client.in += '\n';  // the last line may lack its end
      client.closing = true;
      break;
    }
    client.in.append(buffer, static_cast<size_t>(got));
  }
  answerLines(client);
  actAtOnce(client);
  return true;
}

std::optional<Reply> Server::urgent(const Client& client, const std::string& line) {
  return service_.urgent ? service_.urgent(client.peer, line) : std::nullopt;
}

/// Answers the lines of a client in their order, one at a time.
void Server::answerLines(Client& client) {
  size_t end = 0;
  while (!client.asked && client.waiting < kMaxWaiting && (end = client.in.find('\n')) != std::string::npos) {
    std::string line = client.in.substr(0, end);
    std::optional<Reply> reply = urgent(client, line);
    if (!reply && !client.seated) break;
    client.in.erase(0, end + 1);
    client.scanned -= std::min(client.scanned, end + 1);
    if (!reply) return ask(client, std::move(line));
    reply->line += '\n';
    queue(client, std::move(*reply));
  }
  if (client.in.empty()) client.given.clear();  // no line is left to which the descriptors could belong
  if (client.in.size() > kMaxRequestBytes && client.in.find('\n') == std::string::npos) {
    queue(client, refusal("the request is longer than " + std::to_string(kMaxRequestBytes) +
                          " bytes, expected a shorter line") +
                      "\n");
    client.in.clear();
    client.closing = true;
  }
}

/// Carries out an urgent line at once, even if an earlier request is still worked on. The answer is sent in its turn.
void Server::actAtOnce(Client& client) {
  if (!client.asked && client.seated) return;
  for (size_t end; (end = client.in.find('\n', client.scanned)) != std::string::npos; client.scanned = end + 1)
    (void)urgent(client, client.in.substr(client.scanned, end - client.scanned));
}

/// Returns how many descriptors of waiting lines the server holds.
size_t Server::given() const {
  size_t sum = 0;
  for (const Client& client : clients_) sum += client.given.size();
  return sum;
}

/// Takes the descriptors that a line names. Descriptors come in the order of the lines.
std::vector<Descriptor> Server::takeGiven(Client& client, const std::string& line) {
  std::vector<Descriptor> taken;
  const auto request = client.given.empty() ? Result<Request>(Error{}) : parseRequest(line);
  const size_t count = request ? std::min(request->files.size(), client.given.size()) : 0;
  for (size_t i = 0; i < count; ++i) taken.push_back(std::move(client.given[i]));
  client.given.erase(client.given.begin(), client.given.begin() + static_cast<std::ptrdiff_t>(count));
  if (client.in.empty()) client.given.clear();  // no line is left to which the descriptors could belong
  return taken;
}

void Server::ask(Client& client, std::string line) {
  client.asked = client.known = true;
  client.peer.asked = monotonicNow();
  std::vector<Descriptor> files = takeGiven(client, line);
  worker_.post({Job::Kind::kAnswer, client.peer, std::move(line), std::move(files)});
}

/// Does one job; called in the worker's thread.
bool Server::work(Job& job, JobResult& done) {
  done.peer = job.peer.id;
  done.answers = job.kind == Job::Kind::kAnswer;
  if (job.kind == Job::Kind::kLeft && service_.left) service_.left(job.peer);
  if (job.kind == Job::Kind::kLeft) return false;
  if (job.kind == Job::Kind::kNews && service_.news) done.reply.line = service_.news(job.peer);
  if (done.answers) {
    done.reply = service_.answer(job.peer, job.line, std::move(job.files));
    done.reply.line += '\n';
  }
  if (service_.keep_alive) done.keep_alive = service_.keep_alive(job.peer);
  return true;
}

void Server::takeDone() {
  for (JobResult& done : worker_.take()) {
    const auto client =
        std::find_if(clients_.begin(), clients_.end(), [&](const Client& c) { return c.peer.id == done.peer; });
    if (client == clients_.end()) continue;  // the client has left meanwhile
    client->keep_alive = done.keep_alive;
    (done.answers ? client->asked : client->listening) = false;
    if (!done.reply.line.empty() && !client->hung) queue(*client, std::move(done.reply));
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
    client.since = 0;  // it reads, however slowly
    if (next.line.empty()) client.out.pop_front();
  }
  answerLines(client);  // lines that waited until earlier answers were sent
  return true;
}

bool Server::patient(Client& client, Nanoseconds now) {
  const bool our_turn = client.asked || !client.seated || (client.in.empty() && client.out.empty());
  if (our_turn)
    client.since = 0;
  else if (client.since == 0)
    client.since = now;
  return client.since == 0 || now - client.since < kPatience;
}

}  // namespace hapticd::control
