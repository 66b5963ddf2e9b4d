// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
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
constexpr int kClosed = 114;  ///< exit code of a child whose answer has no file any more, because its work closed it
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

/// Sends the answer and ends the process.
[[noreturn]] void endWith(const std::string& bytes, int fd, ChildProgress* whole_end) {
  if (!writeAll(fd, bytes)) _exit(errno == EBADF ? kClosed : 1);
  if (whole_end == nullptr) _exit(0);
  whole_end->answer();
#ifndef HAPTICD_SANITIZED  // they would report what the parent has not freed yet
  std::exit(0);
#else
  _exit(0);
#endif
}

/// Does the child's work and ends the process. A crash leaves no core file.
[[noreturn]] void answer(const std::function<std::string()>& work, int fd, ChildProgress* whole_end = nullptr) {
  const rlimit no_core{0, 0};
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would end it otherwise
  setrlimit(RLIMIT_CORE, &no_core);
  answer_fd = fd;
  // It depends on the compiler whether an exception from a constructor passes through dlopen() or ends the process
  // there.
  std::set_terminate(&endByException);
  try {
    endWith(work(), fd, whole_end);
  } catch (...) {
    endByException();
  }
}

/// The main function of a fork: it has the signals of a new program, and prints nothing.
[[noreturn]] void childMain(const std::function<std::string()>& work, int fd, ChildProgress* whole_end) {
  for (const int signal : kFatal) ::signal(signal, SIG_DFL);
  if (const int null = open("/dev/null", O_RDWR | O_CLOEXEC); null >= 0) {
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
  }
  answer(work, fd, whole_end);
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
  Allowance(pid_t child, milliseconds limit) : child_(child), limit_(limit) { restart(); }

  void restart() {
    begun_ = steady_clock::now();
    end_ = begun_ + limit_;
    waited_ = keptWaiting(child_);
  }

  /// Returns the remaining time; it is more than 0 while the child may go on.
  milliseconds left() {
    const auto now = steady_clock::now();
    if (now >= end_) end_ = begun_ + limit_ + std::min<nanoseconds>(keptWaiting(child_) - waited_, 9 * limit_);
    return std::chrono::ceil<milliseconds>(end_ - now);
  }

  /// Returns the time since the beginning in which the child did not wait for a processor.
  nanoseconds taken() const { return steady_clock::now() - begun_ - (keptWaiting(child_) - waited_); }

 private:
  pid_t child_;
  milliseconds limit_;
  nanoseconds waited_{};
  steady_clock::time_point begun_, end_;
};

/// The limits of the whole work of a child, and of each piece of it.
class Limits {
 public:
  Limits(pid_t child, int limit_ms, const ChildWatch& watch)
      : whole_(child, milliseconds(limit_ms)), piece_(child, milliseconds(watch.piece_ms)), watch_(watch) {}

  /// Returns how long to wait before this is asked again; 0 if the child has taken too long.
  milliseconds left() {
    constexpr milliseconds kLook(1000);
    const milliseconds left = std::min(std::max(whole_.left(), milliseconds(0)), kLook);
    if (watch_.progress == nullptr || left.count() == 0) return left;
    const uint64_t pieces = watch_.progress->pieces();
    if (pieces == 0 || pieces != seen_) piece_.restart();
    seen_ = pieces;
    late_ = pieces != 0 && watch_.piece_ms > 0 && piece_.left().count() <= 0;
    if (pieces != 0 && watch_.waits) watch_.waits(std::chrono::duration<double>(piece_.taken()).count());
    return late_ ? milliseconds(0) : left;
  }

  /// Says what took too long, once left() is 0.
  std::string exceeded(int limit_ms) const {
    const double seconds = (late_ ? watch_.piece_ms : limit_ms) / 1000.0;
    char text[64];
    std::snprintf(text, sizeof text, late_ ? "did not return within %g s" : "took longer than %g s", seconds);
    return text;
  }

 private:
  Allowance whole_, piece_;
  const ChildWatch& watch_;
  uint64_t seen_ = 0;
  bool late_ = false;
};

/// True if the child has ended. Its status is kept.
bool hasEnded(pid_t child) {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == child;
}

/// Reads everything that the child writes until it closes the pipe, or has ended: another process that it started may
/// keep the pipe open. Returns nothing if the time ends first.
std::optional<std::string> readAll(pid_t child, int fd, Limits& allowed) {
  std::string bytes;
  char buffer[16384];
  while (bytes.size() < kLargestAnswer) {
    const milliseconds left = allowed.left();
    if (left.count() <= 0) return std::nullopt;
    const bool ended = hasEnded(child);  // what it has written is in the pipe by now
    pollfd waiting{fd, POLLIN, 0};
    const int ready = poll(&waiting, 1, ended ? 0 : static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return std::nullopt;
    if (ready == 0 && ended) return bytes;
    if (ready <= 0) continue;
    const ssize_t got = read(fd, buffer, sizeof buffer);
    if (got == 0) return bytes;
    if (got < 0 && errno != EINTR) return std::nullopt;
    if (got > 0) bytes.append(buffer, static_cast<size_t>(got));
  }
  return std::nullopt;
}

/// Ends a child that took too long, and returns its status. It may first note where it is.
int endLate(pid_t child) {
  constexpr auto kPause = milliseconds(1);
  int status = 0;
  kill(child, SIGPROF);
  for (int waits = 0; waits < 1000; ++waits) {
    if (waitpid(child, &status, WNOHANG) != 0) return status;
    std::this_thread::sleep_for(kPause);
  }
  kill(child, SIGKILL);
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

/// Waits for the end of the child, and returns its status. A child that closed the pipe but does not end in time is
/// ended; then `in_time` becomes false.
int waitFor(pid_t child, Limits& allowed, bool& in_time) {
  constexpr auto kPause = milliseconds(1);
  int status = 0;
  while (in_time) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR)) return status;
    in_time = allowed.left().count() > 0;
    if (in_time) std::this_thread::sleep_for(kPause);
  }
  return endLate(child);
}

/// Returns the child's answer, or an error that says how the child ended. Closes `fd`, the reading end of the pipe.
Result<std::string> hear(pid_t child, int fd, int limit_ms, const ChildWatch& watch) {
  Limits allowed(child, limit_ms, watch);
  std::optional<std::string> told = readAll(child, fd, allowed);
  close(fd);
  bool in_time = told.has_value();
  const int status = waitFor(child, allowed, in_time);
  if (told && !told->empty() && watch.progress != nullptr && watch.progress->answered()) return *std::move(told);
  if (!in_time) return Error{allowed.exceeded(limit_ms)};
  if (WIFSIGNALED(status)) return Error{std::string("crashed: ") + strsignal(WTERMSIG(status))};
  if (WEXITSTATUS(status) == kThrew) return Error{"threw an exception" + (told->empty() ? "" : ": " + *told)};
  if (WEXITSTATUS(status) == kClosed) return Error{"closed a file that it had not opened"};
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
  std::atomic<uint64_t> pieces{0};
  std::atomic<bool> rests{true}, answered{false};
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

void ChildProgress::beginPiece() noexcept {
  if (mark_ == nullptr) return;
  ++mark_->pieces;
  mark_->rests = false;
}

void ChildProgress::rest() noexcept {
  if (mark_ != nullptr) mark_->rests = true;
}

uint64_t ChildProgress::pieces() const noexcept {
  return mark_ != nullptr && !mark_->rests ? mark_->pieces.load() : 0;
}

void ChildProgress::answer() noexcept {
  if (mark_ != nullptr) mark_->answered = true;
}

bool ChildProgress::answered() const noexcept {
  return mark_ != nullptr && mark_->answered;
}

Result<std::string> runInChild(const std::function<std::string()>& work, int limit_ms, const ChildWatch& watch) {
  int ends[2];
  if (!pipeBeyondStandard(ends)) return notTried("pipe", errno);
  const pid_t child = fork();
  const int code = errno;
  if (child == 0) {
    close(ends[0]);
    childMain(work, ends[1], watch.whole_end ? watch.progress : nullptr);
  }
  close(ends[1]);
  if (child > 0) return hear(child, ends[0], limit_ms, watch);
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
  if (code == 0) return hear(child, ends[0], limit_ms, {});
  close(ends[0]);
  return notTried(arguments[0].c_str(), code);
}

void answerParent(const std::function<std::string()>& work) {
  answer(work, kAnswerFd);
}

}  // namespace hapticd::host
