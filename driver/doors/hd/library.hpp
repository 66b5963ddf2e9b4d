// SPDX-License-Identifier: MIT
/// The state of the whole library. It is made at the first call, which may come from a static constructor. It is never
/// destroyed, so that a program that leaves main() while the scheduler runs does not crash.
#pragma once
#include <array>
#include <mutex>
#include <utility>

#include "arm.hpp"
#include "errors.hpp"
#include "pacer.hpp"
#include "scheduler.hpp"

namespace hapticd::hd {

constexpr size_t kMostArms =
    16;  // handles are 0 to 15, so none equals HD_BAD_HANDLE (260), which some programs test for

class Library {
 public:
  Library() : arms_(made(std::make_index_sequence<kMostArms>())) {}

  std::recursive_mutex lock;  ///< guards the arms and `current`
  ErrorStack errors;
  HHD current = 0;

  std::array<Arm, kMostArms>& arms() { return arms_; }
  /// Returns the open arm of this handle, or nullptr if there is none.
  Arm* find(HHD handle) { return handle < kMostArms && arms_[handle].isOpen() ? &arms_[handle] : nullptr; }
  Scheduler& scheduler() { return scheduler_; }
  double rate() const;  ///< [Hz] rate of the daemon

  /// Puts an error of the current device on the stack of errors.
  void fail(HDerror code) { errors.push(code, current); }
  /// Returns the current arm. If there is none, puts an error on the stack and returns nullptr.
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
