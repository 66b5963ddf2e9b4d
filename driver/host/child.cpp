#include "host/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <optional>

namespace hapticd::host {
namespace {

constexpr size_t kLargestAnswer = 64u << 20;
constexpr int kThrew = 113;  ///< exit code of a child that an exception ended

bool writeAll(int fd, const std::string& bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t written = write(fd, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<size_t>(written);
  }
  return true;
}

/// The child: no core file, no output of its own, and never back into the parent's code.
[[noreturn]] void childMain(const std::function<std::string()>& work, int fd) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM}) ::signal(signal, SIG_DFL);
  if (const int null = open("/dev/null", O_RDWR | O_CLOEXEC); null >= 0) {
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
  }
  // An exception out of a constructor comes through dlopen() or ends there, as the compilers of plugin and host will.
  std::set_terminate([] { _exit(kThrew); });
  try {
    _exit(writeAll(fd, work()) ? 0 : 1);
  } catch (...) {
    _exit(kThrew);
  }
}

/// Everything the child writes until it closes the pipe; nothing when the time is over first.
std::optional<std::string> readAll(int fd, int limit_ms) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(limit_ms);
  std::string bytes;
  char buffer[16384];
  while (bytes.size() < kLargestAnswer) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return std::nullopt;
    pollfd waiting{fd, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(left.count()));
    if (ready == 0 || (ready < 0 && errno != EINTR)) return std::nullopt;
    if (ready < 0) continue;
    const ssize_t got = read(fd, buffer, sizeof buffer);
    if (got == 0) return bytes;
    if (got < 0 && errno != EINTR) return std::nullopt;
    if (got > 0) bytes.append(buffer, static_cast<size_t>(got));
  }
  return std::nullopt;
}

int waitFor(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

Result<std::string> runInChild(const std::function<std::string()>& work, int limit_ms) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return Error{std::string("could not be tried: pipe: ") + std::strerror(errno)};
  const pid_t child = fork();
  if (child < 0) {
    const std::string reason = std::strerror(errno);
    close(ends[0]);
    close(ends[1]);
    return Error{"could not be tried: fork: " + reason};
  }
  if (child == 0) {
    close(ends[0]);
    childMain(work, ends[1]);
  }
  close(ends[1]);
  std::optional<std::string> answer = readAll(ends[0], limit_ms);
  close(ends[0]);
  if (!answer) kill(child, SIGKILL);  // also ends a child that wrote enough but hangs
  const int status = waitFor(child);
  if (!answer) return Error{"took longer than " + std::to_string(limit_ms / 1000.0).substr(0, 4) + " s"};
  if (WIFSIGNALED(status)) return Error{std::string("crashed: ") + strsignal(WTERMSIG(status))};
  if (WEXITSTATUS(status) == kThrew) return Error{"threw an exception"};
  if (WEXITSTATUS(status) != 0 || answer->empty())
    return Error{"ended the process with code " + std::to_string(WEXITSTATUS(status))};
  return *std::move(answer);
}

}  // namespace hapticd::host
