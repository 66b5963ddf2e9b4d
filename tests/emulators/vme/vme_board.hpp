// SPDX-License-Identifier: MIT
/// The arm controller board at the other end of a VME mailbox: its blocks as bytes, written down a second time by hand
/// from driver/docs/vme_board.md, and behind them a simulated arm with the hand that holds it.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "host/catalog.hpp"
#include "host/device_instance.hpp"

namespace hapticd::emulator {

inline constexpr size_t kVmeBlock = 80;  ///< bytes of either block
using VmeBlock = std::array<uint8_t, kVmeBlock>;

/// What the board can be told to do wrong. In turn: it sends the last two blocks that it wrote again, one after the
/// other.
enum class VmeFault { kNone, kSilent, kTorn, kCorrupt, kProtocol, kHydraulics, kJump, kHalfRate, kAbsent, kInTurn };

class VmeBoard {
 public:
  static constexpr size_t kJoints = 10;
  static constexpr double kWatchdog = 0.02;  ///< [s] without a command: valves closed

  /// @param arm device file of a simulated arm of eight joints. Throws std::runtime_error.
  VmeBoard(const std::filesystem::path& arm, host::Catalog& catalog);

  /// One period of the board's loop: takes the command block, moves the arm, fills the state block.
  /// @param seconds since the last one @return false: nothing is to be written this time
  bool cycle(const VmeBlock& command, VmeBlock& state, double seconds);

  void spoil(VmeFault fault) { fault_ = fault; }
  VmeFault fault() const { return fault_; }
  /// Power off and on: counters from zero, sequence from zero, not calibrated for a while.
  void restart();

  bool pushed() const { return pushed_; }          ///< the valves were open in the last period
  bool followed() const { return followed_; }      ///< on references
  uint64_t commands() const { return commands_; }  ///< good ones so far
  const hdv_sample& truth() const { return sample_; }
  host::DeviceInstance& arm() { return *arm_; }

 private:
  void obey(const VmeBlock& command, double seconds);
  void drive();
  void fill(VmeBlock& state);

  std::unique_ptr<host::DeviceInstance> arm_;
  hdv_sample sample_{};
  std::array<double, kJoints> torque_{}, reference_{};
  std::array<VmeBlock, 2> last_{};
  uint64_t now_ns_ = 1, commands_ = 0, cycles_ = 0;
  double silence_ = 1, since_start_ = 1;
  uint16_t sequence_ = 0, starts_ = 1, heard_ = 0;
  bool enabled_ = false, follow_ = false, pushed_ = false, followed_ = false;
  VmeFault fault_ = VmeFault::kNone;
};

}  // namespace hapticd::emulator
