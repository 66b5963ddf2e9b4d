// SPDX-License-Identifier: MIT
/// How long it takes from a report to the command that answers it, on the wire: every few reports the encoders show the
/// arm a little further inside, or outside again, and the first command that answers with another torque ends the wait.
#pragma once
#include <vector>

#include "base/clock.hpp"
#include "emulators/firmware.hpp"

namespace hapticd::emulator {

class StepMeter {
 public:
  /// @param angle [rad] of a step of every joint; 0: no steps. @param least change of a torque that answers one
  StepMeter(double angle, int least) : angle_(angle), least_(least) {}

  /// A report goes out. @return what to add to every joint [rad]
  double report(Nanoseconds now);
  /// A command came.
  void command(Nanoseconds now, const Currents& current);
  /// "latency p50 ... us ...", or nothing where there were no steps.
  void tell() const;

 private:
  static constexpr uint64_t kReportsAStep = 16;
  double angle_;
  int least_;
  uint64_t reports_ = 0;
  Nanoseconds stepped_at_ = 0;  ///< 0: answered
  Currents last_{};
  std::vector<double> took_us_;
};

}  // namespace hapticd::emulator
