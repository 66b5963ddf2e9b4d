// SPDX-License-Identifier: MIT
/// Finds the function of a plugin that allocates, from the call stack of its first allocation.
#pragma once
#include <string>

namespace hapticd::conformance {

/// Surrounds one call of step(). The first allocation during any such call is recorded.
class AllocationWatch {
 public:
  AllocationWatch() noexcept;
  ~AllocationWatch();
  AllocationWatch(const AllocationWatch&) = delete;
  AllocationWatch& operator=(const AllocationWatch&) = delete;
};

/// [main] From now on AllocationWatch objects take effect.
void watchAllocations();

/// Returns the function of that file that made the first allocation, and how to find its line: " in NAME (...)".
/// Returns "" if no allocation was seen, or if the function is unknown.
std::string firstAllocationIn(const std::string& file);

}  // namespace hapticd::conformance
