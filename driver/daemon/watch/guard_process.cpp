// SPDX-License-Identifier: MIT
#include "watch/guard_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <new>
#include <string>

namespace hapticd::watch {

namespace {

constexpr int kBeyond = 16;  ///< lowest number for descriptors, so that they do not overwrite the guard's

Error cannot(const char* what) {
  return Error{std::string("cannot start the guard process: ") + what + ": " + std::strerror(errno) +
               "\n  if the daemon is killed, the arm may keep its last force\n  fix: keep the switch of the arm's "
               "power within reach"};
}

/// Duplicates the descriptor to a number that the child does not use for its own descriptors.
int above(int fd) {
  const int moved = fcntl(fd, F_DUPFD_CLOEXEC, kBeyond);
  close(fd);
  return moved;
}

/// Returns the inode of an open file; 0 if the descriptor is not open.
uint64_t inodeOf(int fd) {
  struct stat what{};
  return fd >= 0 && fstat(fd, &what) == 0 ? what.st_ino : 0;
}

}  // namespace

Result<std::unique_ptr<GuardProcess>> GuardProcess::start(int priority, Nanoseconds patience) {
  std::unique_ptr<GuardProcess> guard(new GuardProcess);
  guard->priority_ = priority;
  guard->patience_ = patience;
  guard->memory_ = Descriptor(above(memfd_create("hapticd-heartbeat", MFD_CLOEXEC)));
  const int memory = guard->memory_.get();
  if (!guard->memory_ || ftruncate(memory, sizeof(Heartbeat)) != 0) return cannot("memfd_create");
  guard->memory_is_ = inodeOf(memory);
  void* mapped = mmap(nullptr, sizeof(Heartbeat), PROT_READ | PROT_WRITE, MAP_SHARED, memory, 0);
  if (mapped == MAP_FAILED) return cannot("mmap");
  guard->beat_ = new (mapped) Heartbeat;
  if (auto begun = guard->restart(); !begun) return Error{begun.error()};
  return guard;
}

/// The new guard gets the same shared memory, because the servo continues to count its ticks there.
Result<void> GuardProcess::restart() {
  errno = EBADF;
  if (inodeOf(memory_.get()) != memory_is_) return cannot("its memory was closed");
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) return cannot("socketpair");
  socket_ = Descriptor(ends[0]);
  told_.clear();
  const Descriptor other(above(ends[1]));
  return spawn(other.get());
}

Result<void> GuardProcess::spawn(int socket) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, socket, kGuardSocket);
  posix_spawn_file_actions_adddup2(&files, memory_.get(), kGuardMemory);
  posix_spawn_file_actions_addclosefrom_np(&files, kGuardMemory + 1);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID);  // so that Ctrl-C and Ctrl-Z reach only the daemon
  std::array<std::string, 4> words = {"hapticd-guard", kGuardArgument, std::to_string(priority_),
                                      std::to_string(patience_)};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
  errno = posix_spawn(&process_, "/proc/self/exe", &files, &how, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&how);
  if (errno == 0) return {};
  process_ = -1;
  return cannot("posix_spawn");
}

GuardProcess::~GuardProcess() {
  if (beat_ != nullptr) {
    arm(false);
    munmap(beat_, sizeof *beat_);
  }
  socket_ = Descriptor();
  if (process_ > 0) waitpid(process_, nullptr, 0);
}

void GuardProcess::sendSilence(uint32_t arm, const hdv_silence* how) {
  const uint64_t epoch = how != nullptr ? how->epoch : UINT64_MAX;
  const auto known = told_.find(arm);
  if (known != told_.end() && known->second == epoch) return;
  GuardMessage message;
  message.arm = arm;
  message.there = how != nullptr ? 1 : 0;
  if (how != nullptr) message.how = *how;
  const int fd = how != nullptr ? how->fd : -1;
  const std::string bytes(reinterpret_cast<const char*>(&message), sizeof message);
  const ssize_t sent = sendWith(socket_.get(), bytes, {&fd, fd >= 0 ? size_t{1} : size_t{0}});
  if (sent == static_cast<ssize_t>(sizeof message)) told_[arm] = epoch;
}

bool GuardProcess::alive() noexcept {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) == process_) process_ = -1;
  return process_ > 0;
}

}  // namespace hapticd::watch
