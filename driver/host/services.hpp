/// What the host offers to plugins and modules (hsp_host): logging, locked memory, a lossy ring of trace events.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "hapticd/abi.h"

namespace hapticd::host {

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
  const std::string& lastError() const { return last_error_; }  ///< [main] newest message of level error, for set-up failures
  size_t lockedBytes() const { return locked_bytes_; }          ///< [main] given out by alloc

  /// [main] Marks the calling thread as the servo thread, for is_rt_thread.
  static void markServoThread();

 private:
  hsp_host abi_{};
  std::string who_;
  Log log_;
  std::string last_error_;
  std::vector<void*> blocks_;
  size_t locked_bytes_ = 0;
};

}  // namespace hapticd::host
