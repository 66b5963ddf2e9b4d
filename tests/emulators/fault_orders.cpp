// SPDX-License-Identifier: MIT
#include "emulators/fault_orders.hpp"

#include <cstdio>
#include <fstream>
#include <utility>

namespace hapticd::emulator {
namespace {

constexpr std::pair<const char*, Fault> kNames[] = {
    {"none", Fault::kNone},         {"silent", Fault::kSilent},   {"stale", Fault::kStale},
    {"short", Fault::kShort},       {"corrupt", Fault::kCorrupt}, {"firmware", Fault::kFirmware},
    {"hardware", Fault::kHardware}, {"jump", Fault::kJump},       {"half_rate", Fault::kHalfRate},
    {"stalled", Fault::kStalled},
};

}  // namespace

FaultOrders::FaultOrders(std::string file) : file_(std::move(file)) {}

void FaultOrders::read() {
  std::string name;
  std::getline(std::ifstream(file_), name);
  for (const auto& [known, fault] : kNames) {
    if (name != known) continue;
    if (fault != Fault::kNone) name_ = name;
    fault_ = fault;
    stage_ = fault == Fault::kNone ? Stage::kMended : Stage::kOrdered;
    since_ = 0;
  }
}

void FaultOrders::follow(UsbArm& arm, double seconds, bool asked) {
  if (asked) {
    read();
    if (stage_ == Stage::kMended) arm.spoil(Fault::kNone);
  }
  since_ += seconds;
  const bool pushes = arm.arm().pushed();
  if (stage_ == Stage::kOrdered && pushes) {
    arm.spoil(fault_);
    stage_ = Stage::kStruck, since_ = 0;
  } else if (stage_ == Stage::kStruck && !pushes) {
    std::printf("%s: off %.1f ms\n", name_.c_str(), 1e3 * since_);
    stage_ = Stage::kOff;
  } else if (stage_ == Stage::kMended && pushes) {
    std::printf("%s: again %.1f ms\n", name_.c_str(), 1e3 * since_);
    stage_ = Stage::kWell;
  } else {
    return;
  }
  std::fflush(stdout);
}

}  // namespace hapticd::emulator
