// SPDX-License-Identifier: MIT
/// The guard is a separate process that switches the arms off if the daemon has ended (by `_exit`, SIGKILL, or a crash
/// that no handler saw), or if the servo makes no more ticks. It serves arms whose hardware does not switch its motors
/// off by itself.
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
  /// [main] Starts the guard. @param priority SCHED_FIFO priority of the guard, if the process may use it
  /// @param patience [ns] time without a tick after which the guard switches the arms off. Time in which the guard
  /// itself could not run does not count
  static Result<std::unique_ptr<GuardProcess>> start(int priority, Nanoseconds patience);
  ~GuardProcess();  ///< [main] ends the guard without switching any arm off
  GuardProcess(const GuardProcess&) = delete;
  GuardProcess& operator=(const GuardProcess&) = delete;

  /// [main] Sends to the guard how it can switch an arm off. Data that the guard has already are not sent again.
  /// @param how nullptr if the arm cannot be switched off now
  void sendSilence(uint32_t arm, const hdv_silence* how);
  /// [main] Starts or ends the watching. The guard must watch from the first tick on, but not while the process is
  /// stopped on purpose (Ctrl-Z).
  void arm(bool watches) noexcept { beat_->armed.store(watches ? 1 : 0); }
  /// [any] The counter of ticks, which the servo increments.
  std::atomic<uint64_t>& ticks() noexcept { return beat_->ticks; }
  /// [main] True if the guard process lives.
  bool alive() noexcept;
  /// [main] Starts a new guard in place of one that has ended. sendSilence() must be called again for every arm.
  Result<void> restart();

 private:
  GuardProcess() = default;
  Result<void> spawn(int socket);

  int priority_ = 0;
  Nanoseconds patience_ = 0;
  Heartbeat* beat_ = nullptr;
  Descriptor socket_, memory_;
  /// inode of the shared memory; it shows whether other code has closed or replaced the descriptor
  uint64_t memory_is_ = 0;
  int process_ = -1;
  std::map<uint32_t, uint64_t> told_;  ///< the epoch of the data that were sent last, by arm
};

/// [main] The main function of the guard process; it never returns. @param arguments see kGuardArgument
[[noreturn]] void guardMain(int count, char** arguments);

}  // namespace hapticd::watch
