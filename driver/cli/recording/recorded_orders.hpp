// SPDX-License-Identifier: MIT
/// The orders of people and programs in a recording, in words.
#pragma once
#include <string>
#include <vector>

#include "record/recording.hpp"
#include "session/replay/about.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::cli {

/// [main] Returns a line for each order, such as "2.0010 s  enable soft" or "0.1500 s  a program pushes on arm". Leads
/// of models and hands, and models that came or left, are left out, because the events have them; so are decisions of
/// the servo itself. @param models those of this recording
std::vector<std::string> recordedOrders(const record::Recording& recording, const servo::RecordedRun& run,
                                        const servo::RunModels& models);

}  // namespace hapticd::cli
