// SPDX-License-Identifier: MIT
/// The guard process itself. It shares only two descriptors with the daemon, and allocates nothing while it watches.
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

#include "base/os.hpp"
#include "watch/guard_process.hpp"

namespace hapticd::watch {

namespace {

constexpr Nanoseconds kLook = 1'000'000, kOnTime = 2 * kLook;
constexpr Nanoseconds kKillAfter = 1'000'000'000;  ///< [ns] after this time without a tick, the guard kills the daemon
constexpr unsigned kUsbTimeout = 100;              ///< [ms] timeout of a USB transfer
constexpr size_t kMostArms = 16;

struct Target {
  hdv_silence how{};
  Descriptor fd;
};

/// Claims a USB interface. The interface belongs to the daemon while it lives, so it can be claimed only afterwards.
bool claim(int fd, unsigned interface) noexcept {
  if (ioctl(fd, USBDEVFS_CLAIMINTERFACE, &interface) == 0) return true;
  usbdevfs_ioctl disconnect{static_cast<int>(interface), USBDEVFS_DISCONNECT, nullptr};
  (void)ioctl(fd, USBDEVFS_IOCTL, &disconnect);
  return ioctl(fd, USBDEVFS_CLAIMINTERFACE, &interface) == 0;
}

bool silenceUsb(Target& target) noexcept {
  const int fd = target.fd.get();
  if (!claim(fd, target.how.interface)) return false;
  usbdevfs_bulktransfer transfer{target.how.endpoint, target.how.size, kUsbTimeout, target.how.bytes};
  return ioctl(fd, USBDEVFS_BULK, &transfer) >= 0;
}

bool silence(Target& target) noexcept {
  const int fd = target.fd.get();
  const hdv_silence& how = target.how;
  switch (how.kind) {
    case HDV_BY_WRITE:
      return write(fd, how.bytes, how.size) == static_cast<ssize_t>(how.size);
    case HDV_BY_PWRITE:
      return pwrite(fd, how.bytes, how.size, static_cast<off_t>(how.offset)) == static_cast<ssize_t>(how.size);
    case HDV_BY_USB:
      return silenceUsb(target);
    default:
      return false;
  }
}

class GuardLoop {
 public:
  GuardLoop(const Heartbeat& beat, Nanoseconds patience)
      : beat_(beat), patience_(patience), daemon_(getppid()), last_(monotonicNow()) {}

  /// Watches until the daemon has ended.
  void run() {
    while (listen()) checkTicks(monotonicNow());
    if (beat_.armed.load() == 0) return;
    constexpr int kTimes = 3;  // the first command may fail while the kernel cancels a transfer of the daemon
    for (int i = 0; i < kTimes; ++i) silenceAll(true);
    printEnd("the daemon has ended");
  }

 private:
  /// Waits for a message, at most for kLook. Returns false if the daemon's end is closed.
  bool listen() {
    pollfd polled{kGuardSocket, POLLIN, 0};
    if (poll(&polled, 1, static_cast<int>(kLook / 1'000'000)) <= 0) return true;
    GuardMessage message;
    descriptors_.clear();
    const ssize_t got = receiveWith(kGuardSocket, {reinterpret_cast<char*>(&message), sizeof message}, descriptors_);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return false;
    if (got == static_cast<ssize_t>(sizeof message) && message.arm < targets_.size()) take(message);
    return true;
  }

  void take(const GuardMessage& message) {
    Target& target = targets_[message.arm];
    target.fd = Descriptor();
    if (message.there == 0 || descriptors_.empty() || message.how.size > sizeof message.how.bytes) return;
    target.how = message.how;
    target.fd = std::move(descriptors_.front());
  }

  /// Checks that ticks go on. If a check comes late, the machine may have stood still, so only part of the time counts.
  void checkTicks(Nanoseconds now) {
    const Nanoseconds elapsed = now - std::exchange(last_, now);
    const uint64_t ticks = beat_.ticks.load();
    if (beat_.armed.load() == 0 || std::exchange(ticks_, ticks) != ticks) {
      still_ = 0;
      silenced_ = false;
      return;
    }
    still_ += elapsed <= kOnTime ? elapsed : kLook;
    if (still_ > patience_ && !std::exchange(silenced_, true)) {
      silenceAll(false);
      printEnd("the servo makes no more ticks");
    }
    if (still_ > kKillAfter && getppid() == daemon_) kill(daemon_, SIGKILL);
  }

  /// Switches all arms off. @param gone true if the daemon has ended, so that its USB interfaces are free
  void silenceAll(bool gone) noexcept {
    failed_ = false;
    for (Target& target : targets_)
      if (target.fd && (gone || target.how.kind != HDV_BY_USB)) failed_ = !silence(target) || failed_;
  }

  void printEnd(const char* why) const {
    std::fprintf(stderr, "guard: %s: %s\n", why,
                 failed_ ? "an arm could not be switched off; switch it off yourself" : "the arms were switched off");
  }

  const Heartbeat& beat_;
  Nanoseconds patience_;
  pid_t daemon_;
  Nanoseconds last_, still_ = 0;
  uint64_t ticks_ = 0;
  bool silenced_ = false, failed_ = false;
  std::array<Target, kMostArms> targets_;
  std::vector<Descriptor> descriptors_;
};

}  // namespace

void guardMain(int count, char** arguments) {
  for (const int signal : {SIGTERM, SIGINT, SIGQUIT, SIGHUP, SIGPIPE, SIGTSTP, SIGUSR1, SIGUSR2, SIGALRM})
    ::signal(signal, SIG_IGN);
  prctl(PR_SET_NAME, "hapticd-guard");
  constexpr int kMostPriority = 98;
  const int priority = count > 2 ? std::atoi(arguments[2]) : 0;
  if (priority > 0)
    (void)os::setFifo(priority < kMostPriority ? priority : kMostPriority);  // otherwise it is an ordinary thread
  (void)os::lockMemory();
  void* mapped = mmap(nullptr, sizeof(Heartbeat), PROT_READ, MAP_SHARED, kGuardMemory, 0);
  if (mapped == MAP_FAILED || count < 4) _exit(2);
  GuardLoop loop(*static_cast<const Heartbeat*>(mapped), std::strtoull(arguments[3], nullptr, 10));
  loop.run();
  _exit(0);
}

}  // namespace hapticd::watch
