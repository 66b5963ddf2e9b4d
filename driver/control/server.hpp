/// Serves the control socket from one ordinary thread: lines of JSON in, one line of JSON out for each. Everything is
/// bounded: clients, the length of a request, what waits for a client that does not read, and how long half a line
/// waits.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "base/os.hpp"
#include "base/result.hpp"

namespace hapticd::control {

class Server {
 public:
  /// Answers one line, without its end; called from the server's thread.
  using Answer = std::function<std::string(const std::string& line)>;

  static constexpr size_t kMaxClients = 32;
  static constexpr size_t kMaxWaiting = 1 << 20;            ///< [bytes] for a client that does not read
  static constexpr Nanoseconds kIdle = 2'000'000'000;       ///< then a client may be dropped where another waits
  static constexpr Nanoseconds kPatience = 10'000'000'000;  ///< for the rest of a line, or for room to answer

  /// [main] Binds the socket, readable and writable by the owner and by its group. An old socket that nobody serves is
  /// replaced; one that is served is an error. @param group "": the process's own
  static Result<std::unique_ptr<Server>> listen(const std::string& file, const std::string& group = "");
  ~Server();  ///< [main] stops and removes the socket
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::error_code start(Answer answer);  ///< [main]
  void stop();                           ///< [main] after the return nothing more is answered

 private:
  struct Client {
    int fd = -1;
    std::string in, out;
    Nanoseconds since = 0;  ///< half a line, or an answer not yet taken, waits since then; 0: nothing waits
    Nanoseconds heard = 0;  ///< the last time that anything came or went
    bool closing = false;   ///< once `out` is gone
  };
  Server(std::string file, int fd, int wake_read, int wake_write)
      : file_(std::move(file)), fd_(fd), wake_{wake_read, wake_write} {}
  void serve();
  bool maySeat(Nanoseconds now) const;
  void accept(Nanoseconds now);
  bool receive(Client& client);
  void answerLines(Client& client);
  bool send(Client& client);
  bool patient(Client& client, Nanoseconds now);

  std::string file_;
  int fd_;
  int wake_[2];
  Answer answer_;
  std::vector<Client> clients_;
  Nanoseconds accept_after_ = 0;  ///< a refusal of the system is not asked for again and again
  std::atomic<bool> stop_{false};
  os::Thread thread_;
};

}  // namespace hapticd::control
