// SPDX-License-Identifier: MIT
/// Measures how much processor time a thread has used, and how many page faults it has had. A platform that cannot
/// measure them returns zeros: nothing that is computed in virtual time depends on these numbers.
#pragma once
#include <cstdint>

namespace hapticd::os {

/// Names the CPU clock of a thread, so that other threads can read it.
using CpuClock = int;
constexpr CpuClock kNoCpuClock = 1;  ///< CLOCK_MONOTONIC, used while the CPU clock of the thread is unknown

/// [rt] Returns the number of page faults (minor and major) of the calling thread so far.
long pageFaultsOfThread() noexcept;

/// [rt] Returns the CPU clock of the calling thread, so that other threads can read it.
CpuClock cpuClockOfThread() noexcept;
/// [any] Returns the CPU time [ns] that the thread of this clock has used. Async-signal-safe.
uint64_t cpuTime(CpuClock clock) noexcept;
/// [rt] Returns the CPU time [ns] that the calling thread has used.
uint64_t cpuTimeOfThread() noexcept;

/// [any] Returns whether the kernel took the processor from the calling thread since its last call of this function. It
/// makes a system call.
bool wasPreempted() noexcept;

/// [rt] Wakes at most `most` threads, of any process, that wait for a word of shared memory to change; never waits.
/// @return how many were woken
int wakeWaiting(uint32_t* word, int most) noexcept;

}  // namespace hapticd::os
