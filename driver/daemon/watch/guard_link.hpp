// SPDX-License-Identifier: MIT
/// Data that the daemon and its guard process exchange. Both run on the same machine with the same build.
#pragma once
#include <atomic>
#include <cstdint>

#include "hapticd/device_silence.h"

namespace hapticd::watch {

/// Shared memory of the daemon and its guard process.
struct Heartbeat {
  std::atomic<uint64_t> ticks{0};  ///< number of ticks, written by the servo
  std::atomic<uint32_t> armed{0};  ///< 1: a force may be on, so the guard acts if the ticks or the daemon end
};

/// A message about one arm, sent over a socket, with a descriptor if the guard can switch the arm off.
struct GuardMessage {
  uint32_t arm = 0;
  uint32_t there = 0;  ///< 0: the guard cannot switch this arm off now; `how` is then not used
  hdv_silence how{};
};

constexpr const char* kGuardArgument = "--guard-process";  ///< followed by the priority and the patience [ns]
constexpr int kGuardSocket = 3, kGuardMemory = 4;          ///< numbers of the guard's descriptors

}  // namespace hapticd::watch
