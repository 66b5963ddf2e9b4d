// SPDX-License-Identifier: MIT
/// Counts the allocations of each thread, so that a run can report the allocations of its servo thread, which should
/// make none. malloc and the related functions are replaced by wrappers that call those of glibc. So only the daemon is
/// linked with this file.
#pragma once
#include <cstddef>
#include <cstdint>

namespace hapticd {

/// [any] Returns how often this thread has called malloc, calloc, realloc or an aligned variant so far. C++ new calls
/// them too.
uint64_t allocationsOfThread() noexcept;

/// [any] From now on each allocation of this thread calls `look` first. `look` may allocate: its own allocations do not
/// call it again. nullptr ends the calls.
void onAllocation(void (*look)()) noexcept;

/// An allocator in addition to the C library's. The address of a block shows which allocator must free it.
struct OtherAllocator {
  const char *begin, *end;                       ///< range of addresses that contains all its blocks
  void* (*take)(size_t size, size_t alignment);  ///< if it returns nullptr, the block comes from the C library
  void (*give_back)(void* block);
  size_t (*size)(const void* block);
};

/// [any] From now on this thread allocates its blocks from `other`, which must live until the process ends; nullptr
/// ends that. Returns false, and changes nothing, if this build does not replace the C library's functions.
bool allocateFrom(const OtherAllocator* other) noexcept;

}  // namespace hapticd
