// SPDX-License-Identifier: MIT
/// Whose code allocates where nothing may: the servo thread notes it, and the end of a run names the module.
#pragma once
#include <cstdint>

#include "base/blame.hpp"

namespace hapticd {

/// Allocations in the code of one owner.
struct AllocationShare {
  const Owner* owner = nullptr;  ///< nullptr: the daemon's own code, or nobody
  uint64_t count = 0;
};

/// [any] From now on the owners of this thread's allocations are noted; false: no longer. Costs nothing where nothing
/// is allocated.
void noteAllocations(bool on) noexcept;

/// [any] The owner with the most of those that were noted in this process.
AllocationShare mostAllocations() noexcept;

}  // namespace hapticd
