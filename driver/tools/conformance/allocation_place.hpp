// SPDX-License-Identifier: MIT
/// Which function of a plugin allocates, told by the stack of its first allocation.
#pragma once
#include <string>

namespace hapticd::conformance {

/// Stands around one call of step(); the first allocation within any of them is kept.
class AllocationWatch {
 public:
  AllocationWatch() noexcept;
  ~AllocationWatch();
  AllocationWatch(const AllocationWatch&) = delete;
  AllocationWatch& operator=(const AllocationWatch&) = delete;
};

/// [main] From now on an AllocationWatch looks.
void watchAllocations();

/// The function of that file which made the first allocation, and how to find its line: " in NAME (...)". "": none was
/// seen, or it cannot be told.
std::string firstAllocationIn(const std::string& file);

}  // namespace hapticd::conformance
