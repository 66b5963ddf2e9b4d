// SPDX-License-Identifier: MIT
/// Everything that the library knows. It is made at the first call, so that a constructor of another library may be it,
/// and is never destroyed: a program that leaves main() with the servo thread running is not to crash.
#pragma once
#include <array>
#include <mutex>
#include <utility>

#include "arm.hpp"
#include "errors.hpp"
#include "pacer.hpp"
#include "scheduler.hpp"

namespace hapticd::hd {

constexpr size_t kMostArms = 16;  // handles are 0 to 15, never 260, which some programs take for an error

class Library {
 public:
  Library() : arms_(made(std::make_index_sequence<kMostArms>())) {}

  std::recursive_mutex lock;  ///< guards the arms and which of them is current
  ErrorStack errors;
  HHD current = 0;

  std::array<Arm, kMostArms>& arms() { return arms_; }
  /// nullptr if no open arm has this handle.
  Arm* find(HHD handle) { return handle < kMostArms && arms_[handle].isOpen() ? &arms_[handle] : nullptr; }
  Scheduler& scheduler() { return scheduler_; }
  double rate() const;  ///< [Hz] of the daemon

  /// Puts an error on the stack with the current device.
  void fail(HDerror code) { errors.push(code, current); }
  /// The current arm. nullptr if there is none, which is an error.
  Arm* currentArm();

 private:
  template <size_t... I>
  std::array<Arm, kMostArms> made(std::index_sequence<I...>) {
    return {Arm(static_cast<HHD>(I), errors)...};
  }
  std::array<Arm, kMostArms> arms_;
  Pacer pacer_{*this};
  Scheduler scheduler_{pacer_};
};

Library& library();

using Guard = std::lock_guard<std::recursive_mutex>;

}  // namespace hapticd::hd
