// SPDX-License-Identifier: MIT
/// What the host offers to plugins and modules (hsp_host): logging, locked memory, a lossy ring of trace events.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "base/spsc_ring.hpp"
#include "hapticd/abi.h"

namespace hapticd::host {

/// Numbers that a shape traced from the servo thread. Only the shape knows what they mean.
struct TraceEvent {
  uint32_t event = 0;
  double a = 0, b = 0;
};

/// Services for one instance. Lives as long as the instance; not copied, because plugins keep the pointer.
class Services {
 public:
  using Log = std::function<void(int level, const std::string& who, const std::string& text)>;

  /// [main] @param who name of the model or device, put before each message
  Services(std::string who, Log log);
  ~Services();
  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

  const hsp_host* abi() const { return &abi_; }
  /// [main] The newest message of level error, for set-up failures.
  std::string lastError() const;
  /// [main] Forgets that message, so that the next call is not blamed for an older one.
  void forgetError();
  /// [main] What the host itself has to say of the instance.
  void warn(const std::string& text) { write(HSP_LOG_WARNING, text.c_str()); }
  size_t lockedBytes() const { return locked_bytes_; }  ///< [main] how much alloc has given out

  /// [any] Only one reader: the next event of the servo thread. False if there is none.
  bool takeEvent(TraceEvent& event) noexcept { return events_.pop(event); }
  /// [any] True once, after the instance has asked to be activated again.
  bool takeRestartRequest() noexcept { return restart_.exchange(false, std::memory_order_relaxed); }

  /// [main] Marks the calling thread as the servo thread, for is_rt_thread. Messages that instances log on it wait in a
  /// ring of records of fixed size, without a lock, until passOn() is called.
  static void markServoThread();
  /// [main] One reader: passes on what was logged on the servo thread since the last call, and how many messages found
  /// the ring full.
  static void passOn(const Log& log);

 private:
  static constexpr size_t kEvents = 64;  ///< a click or two per tick, read about every 10 ms; the rest may be lost
  struct Block {
    size_t bytes, align;
  };
  static Services& of(const hsp_host* host) { return *static_cast<Services*>(host->ctx); }
  void write(int level, const char* utf8);
  void keep(int level, const char* utf8) const noexcept;
  void* allocate(size_t bytes, size_t align);
  void release(void* block);

  hsp_host abi_{};
  std::string who_;
  Log log_;
  mutable std::mutex mutex_;  // log() is called from the main and the simulation thread
  std::string last_error_;
  std::unordered_map<void*, Block> blocks_;
  size_t locked_bytes_ = 0;
  SpscRing<TraceEvent> events_{kEvents};
  std::atomic<bool> restart_{false};
};

}  // namespace hapticd::host
