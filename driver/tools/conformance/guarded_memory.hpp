// SPDX-License-Identifier: MIT
/// Memory in which a plugin cannot overrun a block unseen: each block ends where an unreadable page begins.
#pragma once
#include <cstddef>

namespace hapticd::conformance {

/// While the object lives, blocks that this thread allocates are guarded, as long as there is room. They stay guarded
/// afterwards, and once they were freed nobody can read them.
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

/// The block beyond which an access to a guarded page went.
struct Overrun {
  size_t block = 0;  ///< [bytes] size that was asked for; 0: the address is not in guarded memory
  size_t at = 0;     ///< [bytes] from its beginning to the address
  bool freed = false;
};

/// [any] The block before an address that could not be read. It allocates nothing, because a signal handler calls it.
Overrun overrunAt(const void* address) noexcept;

}  // namespace hapticd::conformance
