// SPDX-License-Identifier: MIT
/// The services of the host for plugins and modules (hsp_host): logging, locked memory, and a ring of trace events,
/// which may lose events.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "base/spsc_ring.hpp"
#include "hapticd/abi.h"

namespace hapticd::host {

/// Numbers that a shape passed to trace() in the servo thread. The shape alone defines what they mean.
struct TraceEvent {
  uint32_t event = 0;
  double a = 0, b = 0;
};

/// Services for one instance. The object lives as long as the instance. It cannot be copied, because plugins keep a
/// pointer to it.
class Services {
 public:
  using Log = std::function<void(int level, const std::string& who, const std::string& text)>;

  /// [main] @param who name of the model or device, passed to the log with each message
  Services(std::string who, Log log);
  ~Services();
  Services(const Services&) = delete;
  Services& operator=(const Services&) = delete;

  const hsp_host* abi() const { return &abi_; }
  /// [main] Returns the newest message of level error. It explains why a call of the set-up failed.
  std::string lastError() const;
  /// [main] Forgets the newest error, so that it is not taken for the reason if the next call fails.
  void forgetError();
  /// [main] Logs a warning of the host itself about the instance.
  void warn(const std::string& text) { write(HSP_LOG_WARNING, text.c_str()); }
  /// [main] bytes that the instance has allocated with alloc() and not released yet
  size_t lockedBytes() const { return locked_bytes_; }

  /// [any] Takes the next event of the servo thread. Returns false if there is none. There must be only one reader.
  bool takeEvent(TraceEvent& event) noexcept { return events_.pop(event); }

  /// [main] Marks the calling thread as the servo thread, for is_rt_thread(). Messages that instances log in this
  /// thread are kept in a ring without a lock until passOn() is called.
  static void markServoThread();
  /// [main] Passes on the messages of the servo thread since the last call, and the number of messages that were lost
  /// because the ring was full. There must be only one reader.
  static void passOn(const Log& log);

 private:
  static constexpr size_t kEvents = 64;  ///< enough for one or two clicks per tick, read about every 10 ms
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
  mutable std::mutex mutex_;  // because instances call log() in the main thread and in the proximity thread
  std::string last_error_;
  std::unordered_map<void*, Block> blocks_;
  size_t locked_bytes_ = 0;
  SpscRing<TraceEvent> events_{kEvents};
};

}  // namespace hapticd::host
