// SPDX-License-Identifier: MIT
#include <linux/futex.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <type_traits>

#include "base/thread_usage.hpp"

namespace hapticd::os {

static_assert(std::is_same_v<CpuClock, clockid_t> && kNoCpuClock == CLOCK_MONOTONIC);

long pageFaultsOfThread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

CpuClock cpuClockOfThread() noexcept {
  clockid_t clock = CLOCK_THREAD_CPUTIME_ID;
  pthread_getcpuclockid(pthread_self(), &clock);
  return clock;
}

uint64_t cpuTime(CpuClock clock) noexcept {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<uint64_t>(time.tv_sec) * 1'000'000'000u + static_cast<uint64_t>(time.tv_nsec);
}

uint64_t cpuTimeOfThread() noexcept {
  return cpuTime(CLOCK_THREAD_CPUTIME_ID);
}

bool wasPreempted() noexcept {
  static thread_local long known = 0;
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  const bool preempted = usage.ru_nivcsw != known;
  known = usage.ru_nivcsw;
  return preempted;
}

int wakeWaiting(uint32_t* word, int most) noexcept {
  return static_cast<int>(syscall(SYS_futex, word, FUTEX_WAKE, most, nullptr, nullptr, 0));
}

}  // namespace hapticd::os
