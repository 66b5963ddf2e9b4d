// SPDX-License-Identifier: MIT
/// Memory in which an overrun of a block is always noticed, because each block ends where an unreadable page begins.
#pragma once
#include <cstddef>

namespace hapticd::conformance {

/// While an object of this class lives, blocks that this thread allocates are guarded, as long as there is room. They
/// stay guarded after the object was destroyed. A block that was freed can no longer be read.
class GuardedMemory {
 public:
  GuardedMemory() noexcept;
  ~GuardedMemory();
  GuardedMemory(const GuardedMemory&) = delete;
  GuardedMemory& operator=(const GuardedMemory&) = delete;
  bool works() const noexcept { return works_; }  ///< false in builds whose allocator is not hapticd's own

 private:
  bool works_;
};

/// A wrong access to guarded memory: the block that was overrun, and the place in it.
struct Overrun {
  size_t block = 0;  ///< [bytes] size of the block; 0 if the address is not in guarded memory
  size_t at = 0;     ///< [bytes] from the beginning of the block to the address
  bool freed = false;
};

/// [any] Returns the block that ends before an address that could not be accessed. Allocates nothing, because a signal
/// handler calls it.
Overrun overrunAt(const void* address) noexcept;

}  // namespace hapticd::conformance
