// SPDX-License-Identifier: MIT
/// Counts the allocations of each thread, so that a run can say how many its servo thread made (the answer must be 0).
/// Linked into the daemon alone: it replaces malloc and its kind by wrappers of glibc's own.
#pragma once
#include <cstdint>

namespace hapticd {

/// [any] Calls of malloc, calloc, realloc and the aligned kinds by this thread so far; C++ new ends there too.
uint64_t allocationsOfThread() noexcept;

/// [any] From now on each allocation of this thread calls `look` first, which may allocate: it is not called for that.
/// nullptr: none.
void onAllocation(void (*look)()) noexcept;

}  // namespace hapticd
