// SPDX-License-Identifier: MIT
/// Whose code allocates where nothing may: the servo thread notes it, and the end of a run names the module.
#pragma once
#include <cstdint>

#include "base/blame.hpp"

namespace hapticd {

/// How many allocations the code of one owner made.
struct AllocationShare {
  const Owner* owner = nullptr;  ///< nullptr: the daemon's own code, or nobody's
  uint64_t count = 0;
};

/// [any] From now on the owners of this thread's allocations are noted; false ends that. It costs nothing where nothing
/// is allocated.
void noteAllocations(bool on) noexcept;

/// [any] The owner that made most of the allocations noted in this process.
AllocationShare mostAllocations() noexcept;

}  // namespace hapticd
