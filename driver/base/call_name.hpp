// SPDX-License-Identifier: MIT
/// What messages tell beside the owner of a call: which function it is, and where somebody asked for that owner.
#pragma once
#include <atomic>
#include <string>

#include "base/blame.hpp"

namespace hapticd {

namespace detail {
inline thread_local std::atomic<const char*> t_call_name{nullptr};
}

/// The calling thread runs that function of a module while the object lives; such objects may nest. A step names none:
/// if nothing is named, a module is called for its step.
class CallName {
 public:
  /// @param name in static storage: "activate"
  explicit CallName(const char* name) noexcept : before_(detail::t_call_name.load(std::memory_order_relaxed)) {
    detail::t_call_name.store(name, std::memory_order_relaxed);
  }
  ~CallName() { detail::t_call_name.store(before_, std::memory_order_relaxed); }
  CallName(const CallName&) = delete;
  CallName& operator=(const CallName&) = delete;

 private:
  const char* before_;
};

/// [any] The function that the calling thread runs; nullptr: none was named. Async-signal-safe.
inline const char* callNameHere() noexcept {
  return detail::t_call_name.load(std::memory_order_relaxed);
}

/// [main] `place`, such as "scene.yaml:4", asks for that owner. The last one counts.
void keepPlace(const Owner* owner, const std::string& place);
/// [any] The place that asks for that owner; "" if it is unknown. Async-signal-safe.
const char* placeOf(const Owner* owner) noexcept;

}  // namespace hapticd
