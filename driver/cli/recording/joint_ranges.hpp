// SPDX-License-Identifier: MIT
/// Says how far the joints of a recording's models moved, and when they stood at their end stops.
#pragma once
#include <string>
#include <vector>

#include "record/recording.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::cli {

/// [main] Returns a line for each model with a hinge or a slider (parameter joint), such as "door: turned from 0 to 0.6
/// rad; at its stop at 0.6 rad for 2.1 s (2 times: 0.9 to 2 s, 4.9 to 5.9 s)". Positions count from the pose in the
/// scene. @param rate [Hz] of the run
std::vector<std::string> jointRanges(const record::Recording& recording, const servo::RunModels& models, double rate);

}  // namespace hapticd::cli
