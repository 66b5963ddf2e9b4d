// SPDX-License-Identifier: MIT
/// Handles the signals that end or suspend a run: Ctrl-C, SIGTERM, Ctrl-Z.
#pragma once
#include "session/runner.hpp"

namespace hapticd::cli {

/// From now on SIGINT and SIGTERM end the run of the present StopBySignal. If a signal comes before there is a run, the
/// run ends as soon as it exists.
void heedStopSignals();

/// From now on SIGTSTP makes the run ramp its forces out before the process stops.
void heedSuspendSignal();

/// Names the run that signals end, while this object lives. A second Ctrl-C has no further effect on a run that the
/// first is ending.
class StopBySignal {
 public:
  explicit StopBySignal(servo::Runner& runner);
  ~StopBySignal();
  StopBySignal(const StopBySignal&) = delete;
  StopBySignal& operator=(const StopBySignal&) = delete;
};

}  // namespace hapticd::cli
