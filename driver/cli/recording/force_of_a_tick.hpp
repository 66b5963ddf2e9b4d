// SPDX-License-Identifier: MIT
/// Says why the force of an arm is what it is in a tick of a recording.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/recording.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::cli {

/// [main] Returns lines for each arm: the force that it got, that of each model with its depth, face and part along the
/// surface, that of programs, and whether limits changed the sum.
/// @param at [s] the first tick that is not before this time; without it the tick in which each arm got most
Result<std::vector<std::string>> forceLines(const record::Recording& recording, const servo::RunModels& models,
                                            const scene::Scene& scene, std::optional<double> at);

}  // namespace hapticd::cli
