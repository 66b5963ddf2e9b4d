// SPDX-License-Identifier: MIT
/// Gives the scheduler its ticks: those of the daemon or, if there is no daemon, those of a clock of this process.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "errors.hpp"
#include "link.hpp"

namespace hapticd::hd {

class Library;

class Pacer {
 public:
  explicit Pacer(Library& library) : library_(library) {}
  /// Waits for a tick and gives its states to the arms. Only one thread at a time may call it. @return time [ns,
  /// CLOCK_MONOTONIC] at which the tick began
  uint64_t wait();
  /// [any] Sets how long before a tick is due [us] wait() begins to poll instead of sleeping. With 0 it only sleeps
  /// (see hapticd_listen).
  void listen(unsigned microseconds) { listen_us_ = microseconds; }
  void endTick();  ///< tells the daemon, for every arm, that the program still runs
  double rate() const;

 private:
  struct LeadingArm {
    std::shared_ptr<Link> link;
    HHD handle = HD_INVALID_HANDLE;
  };
  LeadingArm first() const;
  bool waitFor(const LeadingArm& lead, hapticd_state& state);
  void missed(const LeadingArm& lead);
  void show(const LeadingArm& lead, const hapticd_state& state, uint64_t ns);

  Library& library_;
  std::mutex waiting_;
  std::weak_ptr<Link> followed_;  ///< the link whose ticks are used; only its arm keeps it open
  uint64_t seen_ = UINT64_MAX, silent_since_ns_ = 0, looked_ns_ = 0;
  bool lost_ = false;  ///< true if it was already reported that the daemon is lost
  std::atomic<unsigned> listen_us_{0};
};

}  // namespace hapticd::hd
