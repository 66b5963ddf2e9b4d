// SPDX-License-Identifier: MIT
/// What the test arm `rig` shares with the test that watches it: a log of every command, cut and stop, what the motors
/// do now, and what the test wishes the arm to do. The page lies in memory of the process, or in a file (parameter
/// `page`) that other processes map and that outlives a daemon that was killed. rig.py reads the same layout.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hapticd::rig {

enum Kind : uint32_t { kOpened, kStarted, kCommand, kCut, kStopped, kClosed };

/// One thing that the host did to the arm.
struct Entry {
  uint64_t time_ns = 0;   ///< CLOCK_MONOTONIC
  uint64_t given_ns = 0;  ///< what the host said that the time is; of commands
  uint32_t kind = kOpened;
  uint32_t on = 0;        ///< 1: the motors have a torque after it
  double torque[3] = {};  ///< [N] of the three sliding joints, so the force at the tip, device frame
};

/// A fault that the test asks for; bits of Wishes::faults.
enum Faults : uint32_t {
  kLost = 1u << 0,           ///< read() answers HSP_E_IO
  kHardwareFault = 1u << 1,  ///< HDV_S_FAULT
  kUncalibrated = 1u << 2,   ///< no HDV_S_CALIBRATED
  kSilent = 1u << 3,         ///< the sequence number stands still
  kHangInRead = 1u << 4,     ///< read() does not come back while this is set
  kHangInWrite = 1u << 5,    ///< the same of write(), after the command was taken
  kHangInWait = 1u << 6,     ///< the same of the pacing wait
  kWriteFails = 1u << 7      ///< write() takes nothing and answers HSP_E_IO
};

/// What the test wishes; written by the test, read by the arm at each call.
struct Wishes {
  double position[3] = {0, 0, 0};        ///< [m] of the tip, device frame
  double orientation[4] = {1, 0, 0, 0};  ///< of the tip, as the kinematics answer it
  double weight[3] = {0, 0, 0};          ///< [N] that the kinematics say the arm's own weight takes
  uint64_t stamp_ns = 0;                 ///< time stamp of the next samples; 0: the time that the host gives
  std::atomic<uint32_t> faults{0};
  uint32_t buttons = 0;
};

/// The electronics: they hold what they were told last, for ever. Who clears `on` has silenced the arm.
struct Motors {
  std::atomic<uint32_t> on{0};
  uint32_t reserved = 0;
  double torque[3] = {};
};

struct Page {
  static constexpr uint64_t kMagic = 0x31454741504749;  // "IGPAGE1"
  static constexpr uint64_t kCapacity = 1u << 18;       ///< entries; the oldest are overwritten

  uint64_t magic = kMagic, capacity = kCapacity;
  std::atomic<uint64_t> count{0};  ///< entries ever written
  std::atomic<uint64_t> reads{0};
  Motors motors;
  Wishes wishes;
  Entry entries[kCapacity];

  const Entry& entry(uint64_t index) const { return entries[index % kCapacity]; }
};

// rig.py reads by these numbers.
static_assert(sizeof(Entry) == 48 && offsetof(Page, count) == 16 && offsetof(Page, motors) == 32 &&
              offsetof(Page, wishes) == 64 && sizeof(Wishes) == 96 && offsetof(Wishes, faults) == 88 &&
              offsetof(Page, entries) == 160);

inline constexpr const char* kPageExtension = "test.rig";  ///< of the device: its Page*

}  // namespace hapticd::rig
