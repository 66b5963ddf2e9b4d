// SPDX-License-Identifier: MIT
#include "serve.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdio>

#include "foxglove.hpp"
#include "page_protocol.hpp"
#include "server.hpp"
#include "stage.hpp"
#include "status/page_file.hpp"

extern char** environ;

namespace hapticd::view {
namespace {

constexpr int kFailed = 1, kBadInput = 2;
constexpr std::chrono::milliseconds kTick(16);

/// Returns whether a daemon holds the lock on its name.
bool daemonLives(const std::string& lock_file) {
  const int fd = open(lock_file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (fd < 0) return errno == EACCES;  // the lock file belongs to another user, so the daemon may run
  const bool free = flock(fd, LOCK_SH | LOCK_NB) == 0;
  close(fd);
  return !free;
}

/// The user's browser, which xdg-open starts. What that prints is dropped, because it names each browser that it did
/// not find; one line replaces it.
class Browser {
 public:
  void open(const std::string& url) {
    std::string program = "xdg-open", address = url;
    char* arguments[] = {program.data(), address.data(), nullptr};
    posix_spawn_file_actions_t silent;
    posix_spawn_file_actions_init(&silent);
    for (const int output : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&silent, output, "/dev/null", O_WRONLY, 0);
    const bool started = posix_spawnp(&child_, program.c_str(), &silent, nullptr, arguments, environ) == 0;
    posix_spawn_file_actions_destroy(&silent);
    if (!started) tell("xdg-open is missing"), child_ = 0;
  }

  /// Tells once if xdg-open has ended and found no browser.
  void look() {
    int status = 0;
    if (child_ <= 0 || waitpid(child_, &status, WNOHANG) != child_) return;
    child_ = 0;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) tell("xdg-open found none");
  }

 private:
  static void tell(const char* why) {
    std::fprintf(stderr, "no browser could be started (%s): open the address above yourself\n", why);
  }

  pid_t child_ = 0;
};

/// Calls onTick() of every conversation 60 times per second, and checks whether the daemon has ended, and the start of
/// the browser.
class Heartbeat {
 public:
  Heartbeat(boost::asio::io_context& io, Stage& stage, Server& server, Browser& browser, std::string lock_file)
      : io_(io), timer_(io), stage_(stage), server_(server), browser_(browser), lock_file_(std::move(lock_file)) {}

  void scheduleNext() {
    timer_.expires_after(kTick);
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      if (server_.sockets() > 0) {
        stage_.tick();
        server_.tick();
      }
      const bool looks = ++beats_ % kLook == 0;
      if (looks) browser_.look();
      if (looks && !lock_file_.empty() && !daemonLives(lock_file_)) return io_.stop();
      if (const auto same = looks && stage_.rows() != nullptr ? stage_.rows()->unchanged() : Result<void>(); !same) {
        error_ = same.error();
        return io_.stop();
      }
      scheduleNext();
    });
  }

  const std::string& error() const { return error_; }  ///< why nothing more can be shown; "" if nothing is wrong

 private:
  /// Number of ticks between two checks of the daemon and the browser: about one second.
  static constexpr unsigned kLook = 64;
  boost::asio::io_context& io_;
  boost::asio::steady_timer timer_;
  Stage& stage_;
  Server& server_;
  Browser& browser_;
  std::string lock_file_, error_;
  unsigned beats_ = 0;
};

std::unique_ptr<PeerSession> startSession(Subprotocol protocol, Peer& peer, Stage& stage) {
  return protocol == Subprotocol::kFoxglove ? startFoxgloveSession(peer, stage) : startPageSession(peer, stage);
}

}  // namespace

int serve(const ServeOptions& options) {
  boost::asio::io_context io(1);
  StageOptions what;
  what.folder = status::runtimeFolderOf(options.name);
  what.name = options.name;
  what.file = options.file;
  what.drawings = options.drawings;
  what.control = options.control && options.file.empty();
  const std::string lock_file = options.until_end ? what.folder + "/" + what.name + ".lock" : "";
  Stage stage(io, what);
  if (auto opened = stage.open(); !opened) {
    std::fprintf(stderr, "error: %s\n", opened.error().c_str());
    return kBadInput;
  }
  auto server = Server::listen(io, options.port,
                               [&](Subprotocol protocol, Peer& peer) { return startSession(protocol, peer, stage); });
  if (!server) {
    std::fprintf(stderr, "error: %s\n", server.error().c_str());
    return kFailed;
  }
  std::printf("%s\n", (*server)->url().c_str());
  std::fflush(stdout);
  Browser browser;
  if (options.open) browser.open((*server)->url());
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&](const auto&, int) { io.stop(); });
  Heartbeat heartbeat(io, stage, **server, browser, lock_file);
  heartbeat.scheduleNext();
  io.run();
  if (heartbeat.error().empty()) return 0;
  std::fprintf(stderr, "error: %s\n", heartbeat.error().c_str());
  return kFailed;
}

}  // namespace hapticd::view
