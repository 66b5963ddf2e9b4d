// SPDX-License-Identifier: MIT
/// Judges what a run felt of one model: a force of the wrong sign, pushes without a contact, energy from nowhere, and a
/// depth that no arm reaches. `run` prints these warnings in its summary, and `check` gives them after it moved the
/// hand once.
#pragma once
#include <string>
#include <vector>

#include "record/report.hpp"

namespace hapticd::record {

/// [main] Returns the warnings about a model, each without a line feed; none for a model that behaves.
std::vector<std::string> contactWarnings(const ModelReport& model);

}  // namespace hapticd::record
