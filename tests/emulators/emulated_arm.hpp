// SPDX-License-Identifier: MIT
/// An arm on the far side of a wire: the firmware's reports and commands as bytes, and behind them motors, a mechanism
/// and the hand that holds it. Transport programs (uhid, USB/IP, umockdev) put it on a bus.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "emulators/firmware.hpp"
#include "emulators/step_meter.hpp"
#include "simulated/parameters.hpp"

namespace hapticd::emulator {

/// How an arm sits on USB.
enum class Bus { kHid, kBulk, kFtdi };

/// Product, ids and whether the arm sends by itself or answers each command.
struct About {
  uint16_t vendor = 0, product = 0;
  const char* name = "";
  size_t input_bytes = 0, output_bytes = 0;
  bool streams = false;
  Bus bus = Bus::kHid;
};

/// Every arm that can be emulated, named as its device file.
const std::vector<std::string>& emulatedKinds();

/// A hand that presses from in front of the arm's calibration pose towards its base and out again.
simulated::Parameters defaultHand(const std::string& kind);

class EmulatedArm {
 public:
  /// @param kind one of emulatedKinds(). Throws std::invalid_argument.
  EmulatedArm(const std::string& kind, const simulated::Parameters& hand);
  ~EmulatedArm();
  EmulatedArm(const EmulatedArm&) = delete;
  EmulatedArm& operator=(const EmulatedArm&) = delete;

  const About& about() const;
  /// Mechanism, motors and hand for `seconds`, with the last command.
  void advance(double seconds);
  /// The report that the firmware sends now; empty: none.
  std::vector<uint8_t> report();
  /// Bytes of a command; wrong ones are ignored, as a firmware does.
  void command(std::span<const uint8_t> bytes);
  void spoil(Fault fault);
  /// Encoders that step, to measure how long answers take; see StepMeter.
  void measureLatency();
  const StepMeter& meter() const;
  /// While still, the hand stays where its script begins.
  void holdStill(bool still);

  /// What the last milliseconds of the truth are.
  Eigen::Vector3d tip() const;
  Eigen::Vector3d start() const;  ///< where the hand's script begins
  bool pushed() const;            ///< a motor has current
  double silence() const;         ///< [s] since the last good command
  uint64_t commands() const;      ///< good ones so far
  int searches() const;           ///< how often it was told to search its zero
  int zeros() const;              ///< how often it found it

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace hapticd::emulator
