// SPDX-License-Identifier: MIT
/// Finds out which module allocates memory on the servo thread, where nothing may be allocated. The summary at the end
/// of a run names the module.
#pragma once
#include <cstdint>

#include "base/code_owner.hpp"

namespace hapticd {

/// How many allocations the code of one owner made.
struct AllocationShare {
  const Owner* owner = nullptr;  ///< nullptr if the code is the daemon's own, or its owner is unknown
  uint64_t count = 0;
};

/// [any] If `on` is true, the owner of each allocation of this thread is noted from now on; false ends that. This costs
/// no time while the thread allocates nothing.
void noteAllocations(bool on) noexcept;

/// [any] Returns the owner with the most allocations noted in this process, and their number.
AllocationShare mostAllocations() noexcept;

}  // namespace hapticd
