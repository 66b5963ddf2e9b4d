// SPDX-License-Identifier: MIT
/// Serves the control socket: each line of JSON from a client is answered by one line of JSON. One ordinary thread
/// reads and writes the sockets; another (request_worker.hpp) works on one request after the other. The first thread
/// itself answers urgent requests, such as a hold. It does so even for clients that still wait for a place. There are
/// limits for the number of clients, the length of a request, the bytes that wait for a client that does not read, and
/// the time to send a line. An answer may carry a descriptor. A client that subscribed also gets news, which are lines
/// that it did not ask for.
#pragma once
#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "base/descriptors.hpp"
#include "base/os.hpp"
#include "base/result.hpp"
#include "control/peer.hpp"
#include "control/request_worker.hpp"

namespace hapticd::control {

class Server {
 public:
  /// Functions that the server calls. The worker's thread calls all of them but `urgent`. All but `answer` may be
  /// empty.
  struct Service {
    /// Answers one line (without its end). `files` are the descriptors for the names in the request's `files`.
    std::function<Reply(const Peer&, const std::string& line, std::vector<Descriptor> files)> answer;
    std::function<KeepAlive(const Peer&)> keep_alive;  ///< called after each answer
    /// Returns lines, each with its end, for a client that listens; "" if there is no news. Called about every
    /// kNewsPeriod, but only if the client has read all earlier lines.
    std::function<std::string(const Peer&)> news;
    std::function<void(const Peer&)> left;  ///< called after the connection has ended
    /// Called from the thread of the sockets. If the line is an urgent request, it does the request at once and returns
    /// the answer; otherwise it returns nothing. If an earlier request of the client is still being carried out, the
    /// function is called again for the same line when the turn of this line has come.
    std::function<std::optional<Reply>(const Peer&, const std::string& line)> urgent;
  };

  static constexpr size_t kMaxClients = 32;
  /// most clients that wait for a place; meanwhile only their urgent requests are answered
  static constexpr size_t kMaxStanding = 16;
  /// most clients with KeepAlive::stays, so that places are left for other clients
  static constexpr size_t kMaxStaying = 24;
  static constexpr Nanoseconds kNewsPeriod = 20'000'000;
  /// [bytes] most bytes that are kept for a client that does not read its answers
  static constexpr size_t kMaxWaiting = 1 << 20;
  static constexpr Nanoseconds kIdle = 2'000'000'000;  ///< [ns] a client idle for longer is dropped if another waits
  /// [ns] longest time for a client to send the rest of a line, or to read nothing of its answers
  static constexpr Nanoseconds kPatience = 10'000'000'000;

  /// [main] Binds the socket; its owner and its group may connect. An old socket that no process serves is replaced. It
  /// is an error if a process serves it. @param group group of the socket; "" takes the group of the process
  static Result<std::unique_ptr<Server>> listen(const std::string& file, const std::string& group = "");
  ~Server();  ///< [main] stops and removes the socket
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::error_code start(Service service);  ///< [main]
  void stop();                             ///< [main] nothing is answered after it returns

 private:
  struct Client {
    int fd = -1;
    Peer peer;
    KeepAlive keep_alive;
    std::string in;
    std::vector<Descriptor> given;  ///< descriptors that came with the lines in `in`, in their order
    std::list<Reply> out;           ///< lines to send, with their ends; a descriptor goes with its line's first byte
    size_t waiting = 0;             ///< [bytes] number of bytes in `out`
    /// time since which the server waits for the rest of a line, or for the client to read more of an answer; 0: it
    /// waits for neither
    Nanoseconds since = 0;
    Nanoseconds heard = 0;   ///< time when bytes were last received or sent
    bool closing = false;    ///< the connection ends when `out` has been sent
    bool hung = false;       ///< the client has closed its side of the connection; its requests are still carried out
    bool seated = true;      ///< it has a place; if false, it waits for one
    bool asked = false;      ///< one of its requests is being carried out
    bool listening = false;  ///< its news are being collected
    bool known = false;      ///< the worker's thread has had a request of this client
    size_t scanned = 0;      ///< [bytes] part of `in` that was already searched for urgent requests
  };
  Server(std::string file, int fd, int wake_read, int wake_write)
      : file_(std::move(file)), fd_(fd), wake_{wake_read, wake_write} {}
  void serve();
  bool listened() const;
  void watch(Client& client, short events, Nanoseconds now);
  void end(Client& client);
  void queue(Client& client, Reply reply);
  bool mayBeDropped(const Client& client, Nanoseconds now) const;
  size_t count(bool seated) const;
  void admitWaiting(Nanoseconds now);
  void makeRoom(bool seated);
  void accept(Nanoseconds now);
  bool receive(Client& client);
  std::optional<Reply> urgent(const Client& client, const std::string& line);
  void answerLines(Client& client);
  void actAtOnce(Client& client);
  size_t given() const;
  static std::vector<Descriptor> takeGiven(Client& client, const std::string& line);
  bool work(Job& job, JobResult& done);
  void ask(Client& client, std::string line);
  void takeDone();
  bool hasPendingReply(const Client& client) const;
  void wake();
  bool send(Client& client);
  bool patient(Client& client, Nanoseconds now);

  std::string file_;
  int fd_;
  int wake_[2];
  Service service_;
  std::list<Client> clients_;  ///< in the order of their connections
  uint64_t last_id_ = 0;
  Nanoseconds news_due_ = 0;
  Nanoseconds accept_after_ = 0;  ///< after a failure of the system, no connection is accepted before this time
  std::atomic<bool> stop_{false};
  RequestWorker worker_;
  os::Thread thread_;
};

}  // namespace hapticd::control
