// SPDX-License-Identifier: MIT
/// Serves the control socket from one ordinary thread: lines of JSON in, one line of JSON out for each. Everything is
/// bounded: clients, the length of a request, what waits for a client that does not read, and how long half a line
/// waits. An answer may carry a descriptor, and a client that subscribed gets lines that it did not ask for.
#pragma once
#include <sys/types.h>

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "base/descriptors.hpp"
#include "base/os.hpp"
#include "base/result.hpp"

namespace hapticd::control {

/// Who asks. The number is never used again.
struct Peer {
  uint64_t id = 0;
  pid_t pid = 0;  ///< of the process that connected
  uid_t uid = 0;
};

/// One line, without its end, and perhaps a descriptor that the client gets along with it.
struct Reply {
  Reply() = default;
  Reply(std::string text) : line(std::move(text)) {}  // NOLINT: implicit by intent
  Reply(std::string text, Descriptor attached) : line(std::move(text)), descriptor(std::move(attached)) {}
  std::string line;
  Descriptor descriptor;
};

/// What a connection is for, beside its requests.
struct Standing {
  bool stays = false;    ///< something lives as long as it does: it is never dropped for being silent
  bool listens = false;  ///< it gets news
};

class Server {
 public:
  /// What the server's thread calls; all but `answer` may be left out.
  struct Service {
    std::function<Reply(const Peer&, const std::string& line)> answer;  ///< one line without its end
    std::function<Standing(const Peer&)> standing;                      ///< after each answer
    /// Lines, each with its end, for one that listens; "" for none. About every kNewsPeriod, and only while it has read
    /// all that came before.
    std::function<std::string(const Peer&)> news;
    std::function<void(const Peer&)> left;  ///< the connection is gone
  };

  static constexpr size_t kMaxClients = 32;
  static constexpr size_t kMaxStaying = 24;  ///< that whoever grants a standing shall let stay: others need places too
  static constexpr Nanoseconds kNewsPeriod = 20'000'000;
  static constexpr size_t kMaxWaiting = 1 << 20;            ///< [bytes] for a client that does not read
  static constexpr Nanoseconds kIdle = 2'000'000'000;       ///< then a client may be dropped where another waits
  static constexpr Nanoseconds kPatience = 10'000'000'000;  ///< for the rest of a line, or for room to answer

  /// [main] Binds the socket, readable and writable by the owner and by its group. An old socket that nobody serves is
  /// replaced; one that is served is an error. @param group "": the process's own
  static Result<std::unique_ptr<Server>> listen(const std::string& file, const std::string& group = "");
  ~Server();  ///< [main] stops and removes the socket
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::error_code start(Service service);  ///< [main]
  void stop();                             ///< [main] after the return nothing more is answered

 private:
  struct Client {
    int fd = -1;
    Peer peer;
    Standing standing;
    std::string in;
    std::list<Reply> out;   ///< with their ends; a descriptor goes with the first byte of its line
    size_t waiting = 0;     ///< [bytes] in `out`
    Nanoseconds since = 0;  ///< half a line, or an answer not yet taken, waits since then; 0: nothing waits
    Nanoseconds heard = 0;  ///< the last time that anything came or went
    bool closing = false;   ///< once `out` is gone
  };
  Server(std::string file, int fd, int wake_read, int wake_write)
      : file_(std::move(file)), fd_(fd), wake_{wake_read, wake_write} {}
  void serve();
  bool listened() const;
  void watch(Client& client, short events, Nanoseconds now);
  void end(Client& client);
  void queue(Client& client, Reply reply);
  bool mayYield(const Client& client, Nanoseconds now) const;
  bool maySeat(Nanoseconds now) const;
  void accept(Nanoseconds now);
  bool receive(Client& client);
  void answerLines(Client& client);
  void tellNews(Client& client);
  bool send(Client& client);
  bool patient(Client& client, Nanoseconds now);

  std::string file_;
  int fd_;
  int wake_[2];
  Service service_;
  std::vector<Client> clients_;
  uint64_t last_id_ = 0;
  Nanoseconds news_due_ = 0;
  Nanoseconds accept_after_ = 0;  ///< a refusal of the system is not asked for again and again
  std::atomic<bool> stop_{false};
  os::Thread thread_;
};

}  // namespace hapticd::control
