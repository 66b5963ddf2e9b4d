// SPDX-License-Identifier: MIT
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

#include "base/bell.hpp"

namespace hapticd {

static_assert(sizeof(std::atomic<uint32_t>) == sizeof(uint32_t),
              "the futex calls of the kernel read the atomic as a plain 32-bit number");

void Bell::wake() noexcept {
  if (sleeps_.load() != 0) syscall(SYS_futex, &strikes_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

void Bell::wait(uint32_t heard, Nanoseconds until) noexcept {
  const timespec end{static_cast<time_t>(until / kNanosecondsPerSecond),
                     static_cast<long>(until % kNanosecondsPerSecond)};
  // This is set before the count is read, so that wake() after any later strike knows that this thread must be woken.
  sleeps_.store(1);
  while (strikes_.load() == heard)
    if (syscall(SYS_futex, &strikes_, FUTEX_WAIT_BITSET_PRIVATE, heard, &end, nullptr, FUTEX_BITSET_MATCH_ANY) != 0 &&
        errno == ETIMEDOUT)
      break;
  sleeps_.store(0);
}

}  // namespace hapticd
