// SPDX-License-Identifier: MIT
/// Counts the allocations of each thread, so that a run can say how many its servo thread made (the answer must be 0).
/// Linked into the daemon alone: it replaces malloc and its kind by wrappers of glibc's own.
#pragma once
#include <cstddef>
#include <cstdint>

namespace hapticd {

/// [any] Calls of malloc, calloc, realloc and the aligned kinds by this thread so far; C++ new ends there too.
uint64_t allocationsOfThread() noexcept;

/// [any] From now on each allocation of this thread calls `look` first. `look` may allocate: it is not called for that.
/// nullptr: nothing is called.
void onAllocation(void (*look)()) noexcept;

/// An allocator beside the C library's. Whoever frees a block, the address tells which allocator it belongs to.
struct OtherAllocator {
  const char *begin, *end;                       ///< all of its blocks lie between
  void* (*take)(size_t size, size_t alignment);  ///< nullptr: the C library's allocator gives this block
  void (*give_back)(void* block);
  size_t (*size)(const void* block);
};

/// [any] From now on this thread's blocks come from `other`, which lives to the end of the process; nullptr ends that.
/// False means that the C library's functions are not replaced in this build, and nothing has changed.
bool allocateFrom(const OtherAllocator* other) noexcept;

}  // namespace hapticd
