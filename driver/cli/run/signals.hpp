// SPDX-License-Identifier: MIT
/// Handles the signals that end or suspend a run: Ctrl-C, SIGTERM, Ctrl-Z.
#pragma once
#include "session/run/runner.hpp"

namespace hapticd::cli {

/// From now on SIGINT and SIGTERM end the run that a StopBySignal names. If a signal comes before there is such an
/// object, the run ends as soon as one is created.
void heedStopSignals();

/// From now on SIGTSTP makes the run ramp out its forces before the process is suspended.
void heedSuspendSignal();

/// While an object of this class lives, signals end the run of its `runner`. While the run ends, a second Ctrl-C has no
/// effect.
class StopBySignal {
 public:
  explicit StopBySignal(servo::Runner& runner);
  ~StopBySignal();
  StopBySignal(const StopBySignal&) = delete;
  StopBySignal& operator=(const StopBySignal&) = delete;
};

}  // namespace hapticd::cli
