// SPDX-License-Identifier: MIT
/// Whether the servo thread of a run allocated memory in its ticks: it may wait for it then.
#pragma once
#include <string>

#include "base/allocation_owner.hpp"
#include "record/report.hpp"

namespace hapticd::record {

/// [any] A warning for people, "" where allocations do not grow with the ticks: an order causes a few.
/// @param most the owner of the code that made most of them
std::string allocationText(const RunReport& report, const AllocationShare& most);

}  // namespace hapticd::record
