// SPDX-License-Identifier: MIT
/// Reports whether the shapes of a run need more time than the period of the servo. In virtual time nothing else shows
/// this, because no deadline is missed.
#pragma once
#include <string>

#include "record/report.hpp"

namespace hapticd::record {

/// [any] Returns lines for people; "" if nothing is slow. The lines name models with many steps that take longer than a
/// whole period, and say if a run in virtual time could not keep up with a real clock. A few slow ticks do not count,
/// because a busy machine causes them. If nothing else is slow, the lines name the model with the longest step,
/// provided that this one step made the loop miss ticks, or in virtual time took more than 50 periods. @param asked_hz
/// rate that the scene asks for
std::string paceText(const RunReport& report, double asked_hz);

}  // namespace hapticd::record
