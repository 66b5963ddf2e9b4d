// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <thread>

#include "host/child.hpp"

namespace hapticd::host {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr size_t kLargestAnswer = 64u << 20;
constexpr int kThrew = 113;   ///< exit code of a child that an exception ended
constexpr int kAnswerFd = 3;  ///< descriptor for the answer; stdout is not used, because loaded code may print
constexpr int kFatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM, SIGQUIT, SIGHUP};

bool writeAll(int fd, const std::string& bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t written = write(fd, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<size_t>(written);
  }
  return true;
}

/// Descriptor to which a child writes its answer. It is global, because a terminate handler has no argument.
int answer_fd = -1;

/// Ends the child because of the present exception. The text of the exception is sent in place of the answer.
[[noreturn]] void endByException() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::exception& e) {
    writeAll(answer_fd, e.what());
  } catch (...) {  // such an exception has no text
  }
  _exit(kThrew);
}

/// Does the child's work and ends the process. A crash leaves no core file.
[[noreturn]] void answer(const std::function<std::string()>& work, int fd) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  answer_fd = fd;
  // It depends on the compiler whether an exception from a constructor passes through dlopen() or ends the process
  // there.
  std::set_terminate(&endByException);
  try {
    _exit(writeAll(fd, work()) ? 0 : 1);
  } catch (...) {
    endByException();
  }
}

/// The main function of a fork: it has the signals of a new program, and prints nothing.
[[noreturn]] void childMain(const std::function<std::string()>& work, int fd) {
  for (const int signal : kFatal) ::signal(signal, SIG_DFL);
  if (const int null = open("/dev/null", O_RDWR | O_CLOEXEC); null >= 0) {
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
  }
  answer(work, fd);
}

/// Settings for posix_spawn: default signals, none of them blocked, no output, and `answer` as the only other file.
class Surroundings {
 public:
  explicit Surroundings(int answer) {
    posix_spawn_file_actions_init(&files_);
    posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&files_, STDIN_FILENO, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files_, STDIN_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&files_, answer, kAnswerFd);
    posix_spawn_file_actions_addclosefrom_np(&files_, kAnswerFd + 1);
    posix_spawnattr_init(&how_);
    sigset_t signals;
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&how_, &signals);
    for (const int signal : kFatal) sigaddset(&signals, signal);
    posix_spawnattr_setsigdefault(&how_, &signals);
    posix_spawnattr_setflags(&how_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~Surroundings() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&how_);
  }
  Surroundings(const Surroundings&) = delete;
  Surroundings& operator=(const Surroundings&) = delete;
  int start(pid_t& child, char* const* arguments) const {
    return posix_spawn(&child, arguments[0], &files_, &how_, arguments, environ);
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t how_;
};

/// Returns how long the child was ready to run but had no processor; 0 if the kernel does not count this time.
nanoseconds keptWaiting(pid_t child) {
  char path[32], words[96] = {};
  std::snprintf(path, sizeof path, "/proc/%d/schedstat", static_cast<int>(child));
  const int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return nanoseconds(0);
  const ssize_t got = read(fd, words, sizeof words - 1);
  close(fd);
  long long ran = 0, waited = 0;
  if (got <= 0 || std::sscanf(words, "%lld %lld", &ran, &waited) != 2) return nanoseconds(0);
  return nanoseconds(waited);
}

/// The time that a child may take. Time for which it waited for a processor on a busy machine is added, up to ten times
/// the limit.
class Allowance {
 public:
  Allowance(pid_t child, milliseconds limit)
      : child_(child), limit_(limit), begun_(steady_clock::now()), end_(begun_ + limit) {}

  /// Returns the remaining time; it is more than 0 while the child may go on.
  milliseconds left() {
    const auto now = steady_clock::now();
    if (now >= end_) end_ = begun_ + limit_ + std::min<nanoseconds>(keptWaiting(child_), 9 * limit_);
    return std::chrono::ceil<milliseconds>(end_ - now);
  }

 private:
  pid_t child_;
  milliseconds limit_;
  steady_clock::time_point begun_, end_;
};

/// Reads everything that the child writes until it closes the pipe. Returns nothing if the time ends first.
std::optional<std::string> readAll(int fd, Allowance& allowed) {
  std::string bytes;
  char buffer[16384];
  while (bytes.size() < kLargestAnswer) {
    const milliseconds left = allowed.left();
    if (left.count() <= 0) return std::nullopt;
    pollfd waiting{fd, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return std::nullopt;
    if (ready <= 0) continue;
    const ssize_t got = read(fd, buffer, sizeof buffer);
    if (got == 0) return bytes;
    if (got < 0 && errno != EINTR) return std::nullopt;
    if (got > 0) bytes.append(buffer, static_cast<size_t>(got));
  }
  return std::nullopt;
}

/// Waits for the end of the child, and returns its status. A child that closed the pipe but does not end in time is
/// killed; then `in_time` becomes false.
int waitFor(pid_t child, Allowance& allowed, bool& in_time) {
  constexpr auto kPause = milliseconds(1);
  int status = 0;
  for (;;) {
    const pid_t ended = waitpid(child, &status, in_time ? WNOHANG : 0);
    if (ended == child || (ended < 0 && errno != EINTR)) return status;
    if (in_time && allowed.left().count() <= 0) {
      in_time = false;
      kill(child, SIGKILL);
    } else if (in_time) {
      std::this_thread::sleep_for(kPause);
    }
  }
}

/// Returns the child's answer, or an error that says how the child ended. Closes `fd`, the reading end of the pipe.
Result<std::string> hear(pid_t child, int fd, int limit_ms) {
  Allowance allowed(child, milliseconds(limit_ms));
  std::optional<std::string> told = readAll(fd, allowed);
  close(fd);
  bool in_time = told.has_value();
  if (!in_time) kill(child, SIGKILL);
  const int status = waitFor(child, allowed, in_time);
  if (!in_time) return Error{"took longer than " + std::to_string(limit_ms / 1000.0).substr(0, 4) + " s"};
  if (WIFSIGNALED(status)) return Error{std::string("crashed: ") + strsignal(WTERMSIG(status))};
  if (WEXITSTATUS(status) == kThrew) return Error{"threw an exception" + (told->empty() ? "" : ": " + *told)};
  if (WEXITSTATUS(status) != 0 || told->empty())
    return Error{"ended the process with code " + std::to_string(WEXITSTATUS(status))};
  return *std::move(told);
}

Error notTried(const char* what, int code) {
  return Error{std::string("could not be tried: ") + what + ": " + std::strerror(code)};
}

/// Opens a pipe whose descriptors are above those of the child's standard streams and its answer. Otherwise, in a
/// process that was started without descriptor 0, 1 or 2, the pipe would get this number, and the child would
/// overwrite it.
bool pipeBeyondStandard(int (&ends)[2]) {
  int low[2];
  if (pipe2(low, O_CLOEXEC) != 0) return false;
  for (int i = 0; i < 2; ++i) ends[i] = fcntl(low[i], F_DUPFD_CLOEXEC, kAnswerFd + 1);
  const int code = errno;
  for (const int fd : low) close(fd);
  if (ends[0] >= 0 && ends[1] >= 0) return true;
  for (const int fd : ends)
    if (fd >= 0) close(fd);
  errno = code;
  return false;
}

}  // namespace

struct ChildProgress::Mark {
  std::atomic<uint32_t> item{0};
  std::atomic<const char*> call{
      ""};  ///< the pointer is valid in both processes: a fork has its parent's literals at the same addresses
};

ChildProgress::ChildProgress() : mark_(nullptr) {
  void* memory = mmap(nullptr, sizeof(Mark), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory != MAP_FAILED) mark_ = new (memory) Mark;
}

ChildProgress::~ChildProgress() {
  if (mark_ != nullptr) munmap(mark_, sizeof(Mark));
}

void ChildProgress::mark(uint32_t item, const char* call) noexcept {
  if (mark_ == nullptr) return;
  mark_->item = item;
  mark_->call = call;
}

uint32_t ChildProgress::item() const noexcept {
  return mark_ != nullptr ? mark_->item.load() : 0;
}

const char* ChildProgress::call() const noexcept {
  return mark_ != nullptr ? mark_->call.load() : "";
}

Result<std::string> runInChild(const std::function<std::string()>& work, int limit_ms) {
  int ends[2];
  if (!pipeBeyondStandard(ends)) return notTried("pipe", errno);
  const pid_t child = fork();
  const int code = errno;
  if (child == 0) {
    close(ends[0]);
    childMain(work, ends[1]);
  }
  close(ends[1]);
  if (child > 0) return hear(child, ends[0], limit_ms);
  close(ends[0]);
  return notTried("fork", code);
}

Result<std::string> runProgram(std::vector<std::string> arguments, int limit_ms) {
  int ends[2];
  if (!pipeBeyondStandard(ends)) return notTried("pipe", errno);
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int code = Surroundings(ends[1]).start(child, pointers.data());
  close(ends[1]);
  if (code == 0) return hear(child, ends[0], limit_ms);
  close(ends[0]);
  return notTried(arguments[0].c_str(), code);
}

void answerParent(const std::function<std::string()>& work) {
  answer(work, kAnswerFd);
}

}  // namespace hapticd::host
