// SPDX-License-Identifier: MIT
#include "record/allocation_text.hpp"

#include <fmt/format.h>

namespace hapticd::record {

std::string allocationText(const RunReport& report, const AllocationShare& most) {
  // fewer allocations, or fewer than one in this many ticks, are not reported
  constexpr uint64_t kSome = 100, kRare = 20;
  const uint64_t all = report.servo_allocations;
  if (all < kSome || all * kRare < report.ticks) return "";
  std::string text = fmt::format("warning: the servo thread allocated memory {} times in {} ticks", all, report.ticks);
  if (most.owner != nullptr)
    text += fmt::format(", mostly in the {} {} ({})", most.owner->device ? "device module" : "plugin",
                        most.owner->module, most.owner->name);
  return text + ": an allocation may have to wait, and then the tick is late\n  fix: allocate the memory " +
         (most.owner == nullptr ? "before the run"
          : most.owner->device  ? "in start(); read(), write() and the kinematics may not allocate"
                                : "in activate(); step(), which is touch() of a shape in C++, may not allocate") +
         "\n";
}

}  // namespace hapticd::record
