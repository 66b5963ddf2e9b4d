// SPDX-License-Identifier: MIT
/// Memory in which a plugin cannot overrun a block unseen: each block ends where an unreadable page begins.
#pragma once
#include <cstddef>

namespace hapticd::conformance {

/// While it lives, the blocks that this thread allocates are guarded ones, as far as there is room for them. They stay
/// guarded when it has gone, and after they were freed nobody can read them.
class GuardedMemory {
 public:
  GuardedMemory() noexcept;
  ~GuardedMemory();
  GuardedMemory(const GuardedMemory&) = delete;
  GuardedMemory& operator=(const GuardedMemory&) = delete;
  bool works() const noexcept { return works_; }  ///< false in builds whose allocator is not ours

 private:
  bool works_;
};

/// What an access to a guarded page went beyond.
struct Overrun {
  size_t block = 0;  ///< [bytes] that were asked for; 0: the address is in no guarded memory
  size_t at = 0;     ///< [bytes] from its begin to the address
  bool freed = false;
};

/// [any] What lies in front of an address that could not be read. Allocates nothing: a signal handler asks.
Overrun overrunAt(const void* address) noexcept;

}  // namespace hapticd::conformance
