// SPDX-License-Identifier: MIT
/// The guard: a process of its own that switches the arms off once the daemon is gone (`_exit`, SIGKILL, a crash that
/// no handler sees) or its ticks stand still. For arms whose hardware does not do so itself.
#pragma once
#include <atomic>
#include <map>
#include <memory>

#include "base/clock.hpp"
#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "watch/guard_link.hpp"

namespace hapticd::watch {

class GuardProcess {
 public:
  /// [main] @param priority SCHED_FIFO of the guard, as far as it is allowed
  /// @param patience [ns] without a tick, seen by punctual looks, before it silences the arms
  static Result<std::unique_ptr<GuardProcess>> start(int priority, Nanoseconds patience);
  ~GuardProcess();  ///< [main] ends it without silencing anything
  GuardProcess(const GuardProcess&) = delete;
  GuardProcess& operator=(const GuardProcess&) = delete;

  /// [main] How an arm is silenced from now on; nullptr if that is impossible now. It repeats nothing.
  void tell(uint32_t arm, const hdv_silence* how);
  /// [main] Whether it watches: from the first tick on, and not while the process is stopped on purpose.
  void arm(bool watches) noexcept { beat_->armed.store(watches ? 1 : 0); }
  /// [any] Counts ticks.
  std::atomic<uint64_t>& ticks() noexcept { return beat_->ticks; }
  /// [main] It lives.
  bool alive() noexcept;
  /// [main] Starts another process in place of one that has ended. It must be told about every arm anew.
  Result<void> restart();

 private:
  GuardProcess() = default;
  Result<void> spawn(int socket);

  int priority_ = 0;
  Nanoseconds patience_ = 0;
  Heartbeat* beat_ = nullptr;
  Descriptor socket_, memory_;
  uint64_t memory_is_ = 0;  ///< its inode: another thread may have closed the descriptor
  int process_ = -1;
  std::map<uint32_t, uint64_t> told_;  ///< epoch by arm
};

/// [main] What the guard process does; it never returns. @param arguments as kGuardArgument says
[[noreturn]] void guardMain(int count, char** arguments);

}  // namespace hapticd::watch
