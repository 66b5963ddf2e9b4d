// SPDX-License-Identifier: MIT
#include "emulators/vme/vme_board.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "emulators/board.hpp"
#include "scene/load.hpp"

namespace hapticd::emulator {
namespace {

constexpr double kCount = 2 * M_PI / 131072;  ///< [rad]
constexpr double kTorque = 0.005;             ///< [N m]
constexpr double kThumb[] = {0.3, -0.1};      ///< [rad] joints that the simulated arm has not

void put16(VmeBlock& block, size_t at, uint32_t value) {
  block[at] = static_cast<uint8_t>(value >> 8);
  block[at + 1] = static_cast<uint8_t>(value);
}
void put32(VmeBlock& block, size_t at, uint32_t value) {
  put16(block, at, value >> 16);
  put16(block, at + 2, value);
}
uint16_t get16(const VmeBlock& block, size_t at) {
  return static_cast<uint16_t>(block[at] << 8 | block[at + 1]);
}
uint32_t get32(const VmeBlock& block, size_t at) {
  return static_cast<uint32_t>(get16(block, at)) << 16 | get16(block, at + 2);
}

}  // namespace

VmeBoard::VmeBoard(const std::filesystem::path& arm, host::Catalog& catalog) {
  const scene::LoadedDevice loaded = scene::loadDevice(arm, catalog);
  if (!loaded.device) throw std::runtime_error(loaded.problems.front().text());
  auto made = host::DeviceInstance::create(*loaded.device, [](int, const std::string&, const std::string&) {});
  if (!made) throw std::runtime_error(made.error());
  arm_ = std::move(*made);
  if (auto opened = arm_->open(); !opened) throw std::runtime_error(opened.error());
  if (arm_->info().joint_count != kJoints - 2) throw std::runtime_error(arm.string() + ": expected eight joints");
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = arm_->info().rate_hz;
  how.time_ns = now_ns_;
  how.gravity[1] = -9.81;
  if (auto started = arm_->start(how); !started) throw std::runtime_error(started.error());
  arm_->read(now_ns_, sample_);
}

void VmeBoard::restart() {
  ++starts_;
  sequence_ = 0;
  since_start_ = 0;
  silence_ = 1;
  enabled_ = false;
}

void VmeBoard::obey(const VmeBlock& command, double seconds) {
  silence_ += seconds;
  const bool whole = get16(command, 0) == get16(command, 78) && get16(command, 2) == 1 &&
                     get32(command, 4) == 0x53415243 && get16(command, 76) == boardCrc({command.data(), 76});
  if (!whole || get16(command, 0) == heard_) return;
  heard_ = get16(command, 0);
  silence_ = 0;
  ++commands_;
  enabled_ = (get16(command, 8) & 1) != 0;
  follow_ = (get16(command, 8) & 2) != 0;
  for (size_t i = 0; i < kJoints; ++i) {
    torque_[i] = kTorque * static_cast<int16_t>(get16(command, 12 + 2 * i));
    reference_[i] = kCount * static_cast<int32_t>(get32(command, 32 + 4 * i));
  }
}

void VmeBoard::drive() {
  hdv_command command{};
  command.struct_size = sizeof command;
  pushed_ = enabled_ && silence_ <= kWatchdog;
  followed_ = pushed_ && follow_;
  command.mode = !pushed_ ? HDV_OFF : follow_ ? HDV_POSITION : HDV_TORQUE;
  for (size_t i = 0; pushed_ && i < kJoints - 2; ++i) {
    command.torque[i] = torque_[i];
    command.position[i] = reference_[i];
  }
  pushed_ = pushed_ && std::any_of(command.torque, command.torque + kJoints - 2, [](double t) { return t != 0; });
  arm_->write(now_ns_, command);
}

void VmeBoard::fill(VmeBlock& state) {
  state.fill(0);
  put16(state, 0, ++sequence_);
  put16(state, 2, fault_ == VmeFault::kProtocol ? 2 : 1);
  put32(state, 4, 0x5341524d);
  put16(state, 8, starts_);
  const bool calibrated = since_start_ > 0.1;
  put16(state, 10, (calibrated ? 1u : 0u) | (enabled_ ? 2u : 0u) | (fault_ == VmeFault::kHydraulics ? 4u : 0u));
  for (size_t i = 0; i < kJoints; ++i) {
    const double q = i < kJoints - 2 ? sample_.position[i] : kThumb[i - (kJoints - 2)];
    const double tau = i < kJoints - 2 ? sample_.torque[i] : 0;
    const long jump = fault_ == VmeFault::kJump && i == 2 ? 40000 : 0;
    put32(state, 16 + 4 * i, static_cast<uint32_t>(static_cast<int32_t>(std::lround(q / kCount) + jump)));
    put16(state, 56 + 2 * i, static_cast<uint32_t>(std::lround(std::clamp(tau / kTorque, -32767.0, 32767.0))));
  }
  put16(state, 76, boardCrc({state.data(), 76}));
  put16(state, 78, fault_ == VmeFault::kTorn ? sequence_ - 1u : sequence_);
  if (fault_ == VmeFault::kCorrupt) state[20] ^= 0x10;
  if (fault_ == VmeFault::kAbsent) state.fill(0xff);
}

bool VmeBoard::cycle(const VmeBlock& command, VmeBlock& state, double seconds) {
  obey(command, seconds);
  drive();
  now_ns_ += static_cast<uint64_t>(std::llround(seconds * 1e9));
  since_start_ += seconds;
  arm_->read(now_ns_, sample_);
  ++cycles_;
  if (fault_ == VmeFault::kSilent || (fault_ == VmeFault::kHalfRate && cycles_ % 2 == 0)) return false;
  VmeBlock& last = last_[cycles_ % 2];
  if (fault_ != VmeFault::kInTurn) fill(last);
  state = last;
  return true;
}

}  // namespace hapticd::emulator
