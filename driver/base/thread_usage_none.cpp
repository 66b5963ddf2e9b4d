// SPDX-License-Identifier: MIT
/// For platforms that neither measure threads nor share memory with other processes.
#include "base/thread_usage.hpp"

namespace hapticd::os {

long pageFaultsOfThread() noexcept {
  return 0;
}

CpuClock cpuClockOfThread() noexcept {
  return kNoCpuClock;
}

uint64_t cpuTime(CpuClock) noexcept {
  return 0;
}

uint64_t cpuTimeOfThread() noexcept {
  return 0;
}

bool wasPreempted() noexcept {
  return false;
}

int wakeWaiting(uint32_t*, int) noexcept {
  return 0;
}

}  // namespace hapticd::os
