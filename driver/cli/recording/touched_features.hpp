// SPDX-License-Identifier: MIT
/// Says which faces of each model were touched in a recording.
#pragma once
#include <string>
#include <vector>

#include "record/recording.hpp"
#include "session/replay/run_models.hpp"

namespace hapticd::cli {

/// [main] Returns a line for each model that was touched, with its features and how long each was the foot of a
/// contact, such as "crank: engine/crank: face 2 for 1.2 s, engine/crank: face 5 for 0.3 s". Names of faces come from
/// the part that the scene names; other features have numbers. At most five features of a model are named, those of the
/// longest contacts.
/// A line ends with the time in which the model gave no force while it was touched, if there was any.
/// Ticks in which the arm had a fault are no contact. @param rate [Hz] of the run
std::vector<std::string> touchedFeatures(const record::Recording& recording, const servo::RunModels& models,
                                         double rate);

}  // namespace hapticd::cli
