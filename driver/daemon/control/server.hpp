// SPDX-License-Identifier: MIT
/// Serves the control socket from two ordinary threads: lines of JSON in, one line of JSON out for each. One thread has
/// the sockets, another (desk.hpp) works on the requests in turn. What must wait behind nothing, such as a hold, is
/// answered by the first, and has seats of its own where all others are taken. Everything is bounded: clients, the
/// length of a request, what waits for a client that does not read, and how long half a line waits. An answer may carry
/// a descriptor, and a client that subscribed gets lines that it did not ask for.
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
#include "control/desk.hpp"
#include "control/peer.hpp"

namespace hapticd::control {

class Server {
 public:
  /// What the server calls, all but `urgent` from the thread that works on requests; all but `answer` may be left out.
  struct Service {
    /// One line without its end, and the descriptors that it names (see `files` of a request).
    std::function<Reply(const Peer&, const std::string& line, std::vector<Descriptor> files)> answer;
    std::function<Standing(const Peer&)> standing;  ///< after each answer
    /// Lines, each with its end, for a client that listens; "" for none. Called about every kNewsPeriod, and only while
    /// the client has read all that came before.
    std::function<std::string(const Peer&)> news;
    std::function<void(const Peer&)> left;  ///< the connection is gone
    /// From the thread of the sockets: does at once what must wait behind no other request, and answers; nothing: the
    /// line is no such request. Where lines before it are still worked on, it is called again when their turn is over.
    std::function<std::optional<Reply>(const Peer&, const std::string& line)> urgent;
  };

  static constexpr size_t kMaxClients = 32;
  static constexpr size_t kMaxStanding = 16;  ///< of clients beyond those, only urgent requests are answered yet
  static constexpr size_t kMaxStaying = 24;   ///< that whoever grants a standing shall let stay: others need places too
  static constexpr Nanoseconds kNewsPeriod = 20'000'000;
  static constexpr size_t kMaxWaiting = 1 << 20;            ///< [bytes] for a client that does not read
  static constexpr Nanoseconds kIdle = 2'000'000'000;       ///< then a client may be dropped if another waits
  static constexpr Nanoseconds kPatience = 10'000'000'000;  ///< time for the rest of a line, or for room to answer

  /// [main] Binds the socket, readable and writable by the owner and by its group. An old socket that nobody serves is
  /// replaced; one that is served is an error. @param group "": the process's own
  static Result<std::unique_ptr<Server>> listen(const std::string& file, const std::string& group = "");
  ~Server();  ///< [main] stops and removes the socket
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::error_code start(Service service);  ///< [main]
  void stop();                             ///< [main] after it returns nothing more is answered

 private:
  struct Client {
    int fd = -1;
    Peer peer;
    Standing standing;
    std::string in;
    std::vector<Descriptor> given;  ///< came with the lines in `in`, in their order
    std::list<Reply> out;           ///< with their line ends; a descriptor is sent with the first byte of its line
    size_t waiting = 0;             ///< [bytes] in `out`
    Nanoseconds since = 0;          ///< half a line, or an answer not yet taken, waits since then; 0: nothing waits
    Nanoseconds heard = 0;          ///< the last time that bytes were received or sent
    bool closing = false;           ///< once `out` is gone
    bool hung = false;              ///< nobody reads its answers; what it asked for is done all the same
    bool seated = true;             ///< otherwise it waits for a place
    bool asked = false;             ///< one of its requests is worked on
    bool listening = false;         ///< its news are being collected
    bool known = false;             ///< to those who work on requests
    size_t scanned = 0;             ///< [bytes] of `in` that were already searched for urgent requests
  };
  Server(std::string file, int fd, int wake_read, int wake_write)
      : file_(std::move(file)), fd_(fd), wake_{wake_read, wake_write} {}
  void serve();
  bool listened() const;
  void watch(Client& client, short events, Nanoseconds now);
  void end(Client& client);
  void queue(Client& client, Reply reply);
  bool mayYield(const Client& client, Nanoseconds now) const;
  size_t count(bool seated) const;
  void seat(Nanoseconds now);
  void makeRoom(bool seated);
  void accept(Nanoseconds now);
  bool receive(Client& client);
  std::optional<Reply> urgent(const Client& client, const std::string& line);
  void answerLines(Client& client);
  void actAtOnce(Client& client);
  size_t given() const;
  static std::vector<Descriptor> takeGiven(Client& client, const std::string& line);
  bool work(Job& job, Done& done);
  void ask(Client& client, std::string line);
  void takeDone();
  bool owes(const Client& client) const;
  void wake();
  bool send(Client& client);
  bool patient(Client& client, Nanoseconds now);

  std::string file_;
  int fd_;
  int wake_[2];
  Service service_;
  std::list<Client> clients_;  ///< as they came
  uint64_t last_id_ = 0;
  Nanoseconds news_due_ = 0;
  Nanoseconds accept_after_ = 0;  ///< what the system refused is not asked for again and again
  std::atomic<bool> stop_{false};
  Desk desk_;
  os::Thread thread_;
};

}  // namespace hapticd::control
