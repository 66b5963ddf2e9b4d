// SPDX-License-Identifier: MIT
/// Keeps, for messages about a call, the name of the called function, and the line of the file that names the owner of
/// the function.
#pragma once
#include <atomic>
#include <string>

#include "base/code_owner.hpp"

namespace hapticd {

namespace detail {
inline thread_local std::atomic<const char*> t_call_name{nullptr};
}

/// Notes the function of a module that the calling thread runs, as long as the object lives. Such objects may nest. The
/// step of a shape is not noted: if a module runs and no function is noted, the call is a step.
class CallName {
 public:
  /// @param name name of the function, such as "activate"; it must have static storage
  explicit CallName(const char* name) noexcept : before_(detail::t_call_name.load(std::memory_order_relaxed)) {
    detail::t_call_name.store(name, std::memory_order_relaxed);
  }
  ~CallName() { detail::t_call_name.store(before_, std::memory_order_relaxed); }
  CallName(const CallName&) = delete;
  CallName& operator=(const CallName&) = delete;

 private:
  const char* before_;
};

/// [any] Returns the name of the function that the calling thread runs; nullptr if none was named. Async-signal-safe.
inline const char* callNameHere() noexcept {
  return detail::t_call_name.load(std::memory_order_relaxed);
}

/// [main] Notes which line of a file names that owner. @param place such as "scene.yaml:4"; a later call replaces it
void setPlaceOfOwner(const Owner* owner, const std::string& place);
/// [any] Returns the line of the file that names that owner, such as "scene.yaml:4"; "" if it is unknown.
/// Async-signal-safe.
const char* placeOf(const Owner* owner) noexcept;

}  // namespace hapticd
