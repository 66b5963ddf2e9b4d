// SPDX-License-Identifier: MIT
/// The signals that end a run or suspend it: Ctrl-C, SIGTERM, Ctrl-Z.
#pragma once
#include "session/runner.hpp"

namespace hapticd::cli {

/// From here on SIGINT and SIGTERM end the run that a StopBySignal names. A signal that comes before there is a run
/// ends it as soon as it exists.
void heedStopSignals();

/// From here on SIGTSTP lets the run ramp its forces out before the process stops.
void heedSuspendSignal();

/// The run that signals end, while this object lives. A second Ctrl-C, while the first ends the run, finds no run any
/// more.
class StopBySignal {
 public:
  explicit StopBySignal(servo::Runner& runner);
  ~StopBySignal();
  StopBySignal(const StopBySignal&) = delete;
  StopBySignal& operator=(const StopBySignal&) = delete;
};

}  // namespace hapticd::cli
