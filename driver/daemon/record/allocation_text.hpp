// SPDX-License-Identifier: MIT
/// Reports whether the servo thread allocated memory in its ticks. It should not, because an allocation may have to
/// wait.
#pragma once
#include <string>

#include "base/allocation_owner.hpp"
#include "record/report.hpp"

namespace hapticd::record {

/// [any] Returns a warning for people; "" if there were only few allocations, because each order to the servo causes
/// some.
/// @param most the owner whose code made the most allocations
std::string allocationText(const RunReport& report, const AllocationShare& most);

}  // namespace hapticd::record
