// SPDX-License-Identifier: MIT
/// Whether the shapes of a run leave the servo its period: in virtual time nothing else would show it.
#pragma once
#include <string>

#include "record/report.hpp"

namespace hapticd::record {

/// [any] Lines for people, "" where nothing is slow: the models whose steps take longer than a whole period, and, of a
/// run in virtual time, that a real clock would not be held. A few slow ticks are those of a busy machine.
/// @param asked_hz rate that the scene asks for
std::string paceText(const RunReport& report, double asked_hz);

}  // namespace hapticd::record
