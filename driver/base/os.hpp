// SPDX-License-Identifier: MIT
/// Everything that the daemon needs from the operating system for real time. Only this part calls pthread_*, mlockall,
/// getrusage and similar functions. The pthread functions return their error and do not set errno.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

#include "base/thread_usage.hpp"

namespace hapticd::os {

/// Size of a thread's stack. It is small, because the whole stack is locked in memory; the system's default is 8 MiB.
constexpr size_t kThreadStackBytes = 256 * 1024;
constexpr int kServoPriority = 80;  ///< SCHED_FIFO priority, below that of the kernel's migration threads (99)

/// A thread with a stack of kThreadStackBytes and a name for `ps` and `top`. The destructor waits until the thread has
/// ended.
class Thread {
 public:
  Thread();
  ~Thread();
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  /// [main] Starts `body`. @param name at most 15 characters
  std::error_code start(const std::string& name, std::function<void()> body);
  void join();
  bool running() const { return handle_ != nullptr; }

 private:
  struct Handle;  // the operating system's thread
  std::unique_ptr<Handle> handle_;
  std::function<void()> body_;
};

/// Undoes lockMemory().
void unlockMemory();

/// Gives the calling thread the policy SCHED_FIFO at `priority`.
std::error_code setFifo(int priority);

/// [main] Returns the first line of a file, such as one of /proc or /sys; "" if it cannot be read.
std::string firstLine(const std::string& file);

/// Returns how many processors this machine has, with those that are switched off.
int processors();

/// Pins the calling thread to one processor.
std::error_code pinTo(int cpu);

/// Locks present and future memory, so that no tick has a page fault. calmAllocator() must be called too.
std::error_code lockMemory();

/// Keeps malloc from returning memory to the system, because such memory would have to be locked again when it is used
/// next: one arena, no trimming, no mmap. This call itself locks no memory.
void calmAllocator();

/// Writes to the unused part of the calling thread's stack, so that its pages are present before the first tick.
void prefaultStack();

/// Keeps /dev/cpu_dma_latency at 0 (no deep sleep of the processor) while the object lives.
class DmaLatencyHold {
 public:
  DmaLatencyHold();
  ~DmaLatencyHold();
  DmaLatencyHold(const DmaLatencyHold&) = delete;
  DmaLatencyHold& operator=(const DmaLatencyHold&) = delete;
  bool held() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// Returns the resident memory of the process [bytes].
size_t residentBytes();

/// Returns one line for messages with what affects the right to run in real time: limits, capabilities, cgroup.
std::string realTimeRights();

/// Returns whether the program runs in a virtual machine. In a virtual machine, the host may pause the processors, and
/// busy waiting does not prevent this.
bool inVirtualMachine();

/// [any] Returns the operating system's id of the calling thread. Async-signal-safe.
int threadId() noexcept;

/// Installs a handler for SIGTSTP (Ctrl-Z), and ignores SIGTTIN and SIGTTOU, so that a process in the background is not
/// stopped because it prints.
void onSuspendSignal(void (*handler)(int));

/// [any] Stops the whole process until it is continued.
void suspendProcess();

/// Gives the calling thread a separate stack for handlers of fatal signals, so that they run even if the thread's own
/// stack is full.
void prepareSignalStack();

/// Sets a limit for real-time threads: a thread that runs this long without sleeping gets SIGXCPU, and after twice this
/// time SIGKILL. So an endless loop in a plugin cannot freeze the machine. Lower limits stay in force.
std::error_code limitRealTimeRun(uint64_t us);

/// Installs an async-signal-safe handler for SIGINT, SIGTERM, SIGQUIT and SIGHUP, and ignores SIGPIPE and SIGXFSZ.
void onStopSignal(void (*handler)(int));

}  // namespace hapticd::os
