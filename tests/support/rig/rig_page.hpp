// SPDX-License-Identifier: MIT
/// The page that the test arm `rig` shares with its test: a log of every command, cut and stop, the present state of
/// the motors, and what the test wants the arm to do. The page is in the memory of the process, or in a file (parameter
/// `page`). Other processes can map the file, and it outlives a daemon that was killed. rig.py reads the same layout.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hapticd::rig {

enum Kind : uint32_t { kOpened, kStarted, kCommand, kCut, kStopped, kClosed };

/// One thing that the host did to the arm.
struct Entry {
  uint64_t time_ns = 0;   ///< CLOCK_MONOTONIC
  uint64_t given_ns = 0;  ///< time that the host gave; only for commands
  uint32_t kind = kOpened;
  uint32_t on = 0;        ///< 1 if the motors have a torque after this entry
  double torque[3] = {};  ///< [N] torques of the three sliding joints: the force at the tip, in the device frame
};

/// The faults that a test can ask for, as bits of Wishes::faults.
enum Faults : uint32_t {
  kLost = 1u << 0,           ///< read() answers HSP_E_IO
  kHardwareFault = 1u << 1,  ///< HDV_S_FAULT
  kUncalibrated = 1u << 2,   ///< no HDV_S_CALIBRATED
  kSilent = 1u << 3,         ///< the sequence number no longer changes
  kHangInRead = 1u << 4,     ///< read() does not come back while this is set
  kHangInWrite = 1u << 5,    ///< the same for write(), after the command took effect
  kHangInWait = 1u << 6,     ///< the same for the wait of hdv.pace
  kWriteFails = 1u << 7      ///< write() ignores the command and answers HSP_E_IO
};

/// What the test wants the arm to do. The test writes it, and the arm reads it in each call.
struct Wishes {
  double position[3] = {0, 0, 0};        ///< [m] position of the tip, in the device frame
  double orientation[4] = {1, 0, 0, 0};  ///< orientation of the tip, as the kinematics return it
  double weight[3] = {0, 0, 0};          ///< [N] torques against the arm's own weight, as the kinematics return them
  uint64_t stamp_ns = 0;                 ///< time stamp of the next samples; 0 for the time that the host gives
  std::atomic<uint32_t> faults{0};
  uint32_t buttons = 0;
};

/// The motor electronics, which hold the last command for ever. A process that clears `on` silences the arm.
struct Motors {
  std::atomic<uint32_t> on{0};
  uint32_t reserved = 0;
  double torque[3] = {};
};

struct Page {
  static constexpr uint64_t kMagic = 0x31454741504749;  // "IGPAGE1"
  static constexpr uint64_t kCapacity = 1u << 18;       ///< number of entries; the oldest ones are overwritten

  uint64_t magic = kMagic, capacity = kCapacity;
  std::atomic<uint64_t> count{0};  ///< number of entries that were ever written
  std::atomic<uint64_t> reads{0};
  Motors motors;
  Wishes wishes;
  Entry entries[kCapacity];

  const Entry& entry(uint64_t index) const { return entries[index % kCapacity]; }
};

// rig.py uses these sizes and offsets.
static_assert(sizeof(Entry) == 48 && offsetof(Page, count) == 16 && offsetof(Page, motors) == 32 &&
              offsetof(Page, wishes) == 64 && sizeof(Wishes) == 96 && offsetof(Wishes, faults) == 88 &&
              offsetof(Page, entries) == 160);

inline constexpr const char* kPageExtension = "test.rig";  ///< name of the device's extension that returns its Page*

}  // namespace hapticd::rig
