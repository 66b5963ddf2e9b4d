// SPDX-License-Identifier: MIT
/// What the daemon and its guard process share: same machine, same build.
#pragma once
#include <atomic>
#include <cstdint>

#include "hapticd/device_silence.h"

namespace hapticd::watch {

/// In memory of both.
struct Heartbeat {
  std::atomic<uint64_t> ticks{0};  ///< written by the servo
  std::atomic<uint32_t> armed{0};  ///< a force may be on, so ticks must go on, and so must the daemon
};

/// Sent over a socket, with a descriptor if the arm can be silenced.
struct GuardMessage {
  uint32_t arm = 0;
  uint32_t there = 0;  ///< 0: the arm has left
  hdv_silence how{};
};

constexpr const char* kGuardArgument = "--guard-process";  ///< followed by the priority, and the ns before it silences
constexpr int kGuardSocket = 3, kGuardMemory = 4;          ///< descriptors of the guard

}  // namespace hapticd::watch
