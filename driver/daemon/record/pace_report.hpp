// SPDX-License-Identifier: MIT
/// Whether the shapes of a run leave the servo its period: in virtual time nothing else would show it.
#pragma once
#include <string>

#include "record/report.hpp"

namespace hapticd::record {

/// [any] Lines for people, "" where nothing is slow. They name models whose steps take longer than a whole period, and
/// runs in virtual time that could not keep up with a real clock. A busy machine causes a few slow ticks.
/// @param asked_hz rate that the scene asks for
std::string paceText(const RunReport& report, double asked_hz);

}  // namespace hapticd::record
