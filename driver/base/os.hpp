/// Everything that the daemon asks of the operating system for real time. The only place that calls pthread_*,
/// mlockall, getrusage and their kind; pthread calls return their error and never set errno.
#pragma once
#include <pthread.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <thread>

namespace hapticd::os {

constexpr size_t kThreadStackBytes = 256 * 1024;  ///< explicit: locked memory counts the whole default of 8 MiB
constexpr int kServoPriority = 80;                ///< below the kernel's own migration threads at 99

/// A thread with an explicit stack, named for `ps` and `top`. Joins in its destructor.
class Thread {
 public:
  Thread() = default;
  ~Thread() { join(); }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  /// [main] Starts `body`. @param name at most 15 characters
  std::error_code start(const std::string& name, std::function<void()> body);
  void join();
  bool running() const { return started_; }

 private:
  static void* enter(void* self);
  pthread_t handle_{};
  std::function<void()> body_;
  bool started_ = false;
};

/// Undoes lockMemory.
void unlockMemory();

/// Makes the calling thread SCHED_FIFO at `priority`.
std::error_code setFifo(int priority);

/// Pins the calling thread to one processor.
std::error_code pinTo(int cpu);

/// Locks present and future memory and keeps malloc from giving any back, so that no page fault hits a tick.
std::error_code lockMemory();

/// Keeps one arena and no trimming: the same settings that lockMemory needs, without locking.
void calmAllocator();

/// Touches the stack of the calling thread below its present depth.
void prefaultStack();

/// Holds /dev/cpu_dma_latency at 0 (no deep sleep of the processor) as long as the object lives.
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

/// Page faults (minor and major) of the calling thread so far.
long pageFaultsOfThread() noexcept;

/// Resident memory of the process [bytes].
size_t residentBytes();

/// What bears on real-time rights, in one line for messages: limits, capability, cgroup.
std::string realTimeRights();

/// True inside a virtual machine, where spinning buys nothing against pauses of the host.
bool inVirtualMachine();

/// Installs `onStop` for SIGINT and SIGTERM (async-signal-safe: it stores to a flag only) and ignores SIGPIPE.
void onStopSignal(void (*handler)(int));

}  // namespace hapticd::os
