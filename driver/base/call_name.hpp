// SPDX-License-Identifier: MIT
/// What messages say about a call besides its owner: the name of the function, and the line of the file that names this
/// owner.
#pragma once
#include <atomic>
#include <string>

#include "base/blame.hpp"

namespace hapticd {

namespace detail {
inline thread_local std::atomic<const char*> t_call_name{nullptr};
}

/// Says that the calling thread runs this function of a module, as long as the object lives. Such objects may nest. A
/// step of a shape names no function: if a module runs and no function is named, the call is a step.
class CallName {
 public:
  /// @param name such as "activate", in static storage
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

/// [main] Notes that `place`, such as "scene.yaml:4", asks for that owner. A later call replaces the place.
void keepPlace(const Owner* owner, const std::string& place);
/// [any] Returns the place that asks for that owner; "" if it is unknown. Async-signal-safe.
const char* placeOf(const Owner* owner) noexcept;

}  // namespace hapticd
